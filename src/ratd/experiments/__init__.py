"""What is done with aggregates; experiments do not import each other."""
