//! The mechanical system with ports and laws: the language between models and methods.
