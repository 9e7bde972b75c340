"""Grains spun up until they come apart (Reissl et al. 2024, A&A 692, A60)."""
