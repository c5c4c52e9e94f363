"""Construction of solids: sweeps, lofts, rounded boxes, patterns, chamfers and fillets."""
