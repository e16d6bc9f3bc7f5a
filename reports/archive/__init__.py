"""Documents for the archive: PDF/A with attachments, signatures."""
