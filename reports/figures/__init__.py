"""How figures are drawn: style, plans, SVG."""
