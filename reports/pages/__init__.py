"""Documents as pages: HTML and PDF."""
