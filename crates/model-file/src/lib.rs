//! Model files: TOML with units, schema and messages that point at the line.
