"""What passed before: which tests need not be run again, because nothing that they ran or read has changed.

`contents` hashes what a run reads, `blocks` divides source files into functions, `ran_functions` observes which of them
run, and `memory` keeps the passes in the project.
"""
