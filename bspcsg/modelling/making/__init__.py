"""Making solids: sweeps, lofts, boxes with round edges, patterns, chamfers and fillets."""
