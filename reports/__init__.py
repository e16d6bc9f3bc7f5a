"""Everything a person sees: tables, figures, pages and the command line."""
