"""Holding height in gusts: trim, the map from one wingbeat to the next, gusts, and the map's linear part."""
