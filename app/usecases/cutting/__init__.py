"""Any program cut out of its stock: set-up, stages, report, and the cut played along time."""
