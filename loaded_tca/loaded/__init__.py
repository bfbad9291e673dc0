"""Tooth pairs under load: one contact, the balance over all, the mesh cycle."""
