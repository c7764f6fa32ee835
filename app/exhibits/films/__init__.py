"""The numbered steps of the five texts, each with a picture and its figures; those of 1986 on the bitmap are beside."""
