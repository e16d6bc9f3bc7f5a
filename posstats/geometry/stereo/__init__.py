"""Stereo models: vertical parallax, relative orientation."""
