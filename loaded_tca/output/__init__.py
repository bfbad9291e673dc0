"""Reports, surfaces and stresses as files."""
