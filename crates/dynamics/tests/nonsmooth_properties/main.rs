//! Properties of motions with one-way clutches, dry friction and their like on random systems (theory 05 §2, §9).

mod limits;
mod periodic;
mod random_systems;
mod transients;
