"""`discjump tradeoff`."""
