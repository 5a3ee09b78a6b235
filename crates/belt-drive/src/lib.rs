//! Belt and pulley models that become mechanical systems.
