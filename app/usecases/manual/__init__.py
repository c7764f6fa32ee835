"""The manual: its pages, its tables of parameters, and the site that is made of both."""
