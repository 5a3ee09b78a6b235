//! What users read when a drive is wrong or surprising.
