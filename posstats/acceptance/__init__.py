"""Acceptance: standards and contracts as data, and what check points prove."""
