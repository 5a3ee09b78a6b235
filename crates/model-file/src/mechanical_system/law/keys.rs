//! What the keys of every law have in common: reading, checking, numbers by path, and the law that they describe.

use std::sync::Arc;

use crate::node::Node;
use crate::reader::{Read, TableReader};
use crate::scalar::Scalars;
use crate::smoothing::Smoothing;
use crate::units::Quantity;
use slackside_mechanics::laws::{PiecewiseLinear, Smoothed};

/// A law as the equations of motion have it.
pub(crate) type SharedLaw = Arc<dyn slackside_mechanics::Law>;

/// The keys of one kind of law.
pub(super) trait LawKeys {
    /// Checks the values; `path` is that of the law's table.
    fn check(&self, path: &str) -> Read<()>;

    /// The number at `path`, relative to the law's table; without those of the smoothing.
    fn number_mut(&mut self, path: &str) -> Option<&mut f64>;

    /// Appends the paths of all numbers but those of the smoothing.
    fn collect_keys(&self, prefix: &str, keys: &mut Vec<String>);

    /// The smoothing, if the law has one.
    fn smoothing(&self) -> Option<&Smoothing> {
        None
    }

    /// The smoothing, to be changed.
    fn smoothing_mut(&mut self) -> Option<&mut Smoothing> {
        None
    }

    /// The law that the keys describe; `path` is for errors that only the law finds.
    fn law(&self, path: &str) -> Read<SharedLaw>;
}

/// The methods of [`LawKeys`] for keys that are all named numbers.
macro_rules! scalar_keys {
    () => {
        fn check(&self, path: &str) -> $crate::reader::Read<()> {
            $crate::scalar::Scalars::check_scalars(self, path)
        }

        $crate::mechanical_system::law::keys::scalar_numbers!();
    };
}
pub(super) use scalar_keys;

/// The methods of [`LawKeys`] that find numbers among named ones.
macro_rules! scalar_numbers {
    () => {
        fn number_mut(&mut self, path: &str) -> Option<&mut f64> {
            $crate::scalar::Scalars::scalar_mut(self, path)
        }

        fn collect_keys(&self, prefix: &str, keys: &mut Vec<String>) {
            $crate::scalar::Scalars::collect_scalar_keys(self, prefix, keys);
        }
    };
}
pub(super) use scalar_numbers;

/// The methods of [`LawKeys`] for a field `smoothing`.
macro_rules! smoothing_field {
    () => {
        fn smoothing(&self) -> Option<&$crate::smoothing::Smoothing> {
            self.smoothing.as_ref()
        }

        fn smoothing_mut(&mut self) -> Option<&mut $crate::smoothing::Smoothing> {
            self.smoothing.as_mut()
        }
    };
}
pub(super) use smoothing_field;

/// A law whose keys are named numbers.
pub(super) fn read_plain<T: Scalars + Default>(node: &Node, path: &str) -> Read<T> {
    TableReader::open(node, path, &known_keys::<T>(&[]))?.scalars()
}

/// A law whose keys are named numbers, and which may be smoothed.
pub(super) fn read_smoothable<T: Scalars + Default>(
    node: &Node,
    path: &str,
    width: &Quantity,
) -> Read<(T, Option<Smoothing>)> {
    let table = TableReader::open(node, path, &known_keys::<T>(&["smoothing"]))?;
    Ok((table.scalars()?, read_smoothing(&table, width)?))
}

pub(super) fn read_smoothing(table: &TableReader<'_>, width: &Quantity) -> Read<Option<Smoothing>> {
    table.optional("smoothing", |node, path| Smoothing::read(node, path, width))
}

fn known_keys<T: Scalars>(more: &[&'static str]) -> Vec<&'static str> {
    let scalars = T::SCALARS.iter().map(|scalar| scalar.key);
    ["kind"]
        .into_iter()
        .chain(scalars)
        .chain(more.iter().copied())
        .collect()
}

/// The exact law, or the smooth one that stands for it.
pub(super) fn smoothed(exact: PiecewiseLinear, smoothing: Option<&Smoothing>) -> SharedLaw {
    match smoothing {
        None => Arc::new(exact),
        Some(Smoothing { kind, width }) => Arc::new(Smoothed::new(exact, (*kind).into(), *width)),
    }
}
