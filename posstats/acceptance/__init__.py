"""Acceptance: requirements of standards and contracts as data, and what is judged by them."""
