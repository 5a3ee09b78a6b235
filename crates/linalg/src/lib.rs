//! Dense linear algebra behind plain functions; the only crate that knows the linear-algebra library.
