"""Tooth flanks, each a function theta = Theta(rho, z)."""
