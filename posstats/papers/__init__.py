"""The experiments of two papers, repeated on simulated blocks."""
