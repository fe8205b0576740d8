"""Many logs, each watched by itself: here, in processes, or where a Dask scheduler says."""
