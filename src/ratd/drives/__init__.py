"""What moves an aggregate."""
