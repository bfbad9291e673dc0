"""What an analysis found: the mesh cycle, its key figures, its files."""
