"""What a document is made of: topics, tables, key figures, words; data only."""
