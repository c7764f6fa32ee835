"""Many parts: each made, checked or smoothed by itself, so that one that fails, hangs or is killed harms none."""
