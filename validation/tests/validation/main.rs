//! Tests of the methods against references whose origin is known, and against each other; see this package's README.

mod amplitude_folds;
mod benchmark_problem;
mod common;
mod drive_creep;
mod drive_elastica;
mod drive_linear;
mod drive_steady;
mod drive_strong_form;
mod events;
mod linear;
mod multiple_scales;
mod nonsmooth_files;
mod nonsmooth_periodic;
mod nonsmooth_tables;
mod period_two;
mod properties;
mod several_elements;
mod special_systems;
mod three_methods;
