"""Edges of the flanks of a pair: where they lie, how they soften a tooth, what pressure their roundings carry."""
