"""Questions to drawn curves: where they meet, what they enclose."""
