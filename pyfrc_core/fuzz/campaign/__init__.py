"""Many matches: which are played, where, and what is saved of them.

In: `CampaignOptions` and an executor (`executors`: processes of this computer; `cluster`: those of a Dask cluster).
Out: a `Campaign` with its findings, and the files in tests/fuzz (`corpus`).

With a number of matches, the result depends on the seed alone, not on the number of processes: results are used in the
order of the matches (`playing`).
"""
