"""Semi-analytical loaded tooth contact analysis of gears."""
