"""Space: neighbours, shapes, boxes."""
