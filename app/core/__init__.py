"""What everything else stands on: errors, progress, tolerances, files, threads, compiled kernels. Knows nothing of
parts.
"""
