"""Files, jobs, settings: knows no science."""
