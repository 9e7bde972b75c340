"""What figures share: style, spheres, snapshots, the page in three dimensions."""
