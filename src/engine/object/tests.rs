//! Objects that are looked at without being run.
