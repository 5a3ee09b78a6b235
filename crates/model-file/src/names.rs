//! Names of the items of lists, by which key paths and results refer to them.

use crate::error::Issue;
use crate::node::{Node, Value};
use crate::reader::Read;
use crate::scalar::join;

/// Index of the item with this name, or at this position.
pub(crate) fn named_index<'a>(
    names: impl ExactSizeIterator<Item = &'a str> + Clone,
    item: &str,
) -> Option<usize> {
    let count = names.len();
    names
        .clone()
        .position(|name| name == item)
        .or_else(|| item.parse().ok().filter(|index| *index < count))
}

/// Path of an item of a list by its name, as users write it, if it has one.
pub(crate) fn named_path(node: &Node, path: &str) -> String {
    match (node.child("name").map(|name| &name.value), path.rsplit_once('.')) {
        (Some(Value::Text(name)), Some((list, _))) => join(list, name),
        _ => path.to_owned(),
    }
}

/// Checks the names of the items of a list of tables.
pub(crate) fn check_item_names<'a>(list: &str, names: impl Iterator<Item = &'a str>) -> Read<()> {
    let mut earlier: Vec<&str> = Vec::new();
    for (index, name) in names.enumerate() {
        check_name(&format!("{list}.{index}.name"), name, &earlier)?;
        earlier.push(name);
    }
    Ok(())
}

/// A name must be usable in key paths (`element.clutch.law`) and in initial states (`pulley.rate=0.1,accessory=0`).
pub(crate) fn check_name<N: AsRef<str>>(path: &str, name: &str, earlier: &[N]) -> Read<()> {
    let complaint = if name.trim().is_empty() {
        Some(("a name must not be empty", "give a name"))
    } else if name.contains(['.', ',', '=']) || name.chars().any(char::is_control) {
        Some((
            "a name must not contain dots, commas, equals signs or line breaks",
            "use letters, digits, - and _",
        ))
    } else if name.bytes().all(|byte| byte.is_ascii_digit()) {
        Some((
            "a name must not be a number, which means a position in a list",
            "add a letter",
        ))
    } else if earlier.iter().any(|other| other.as_ref() == name) {
        Some(("the name is already taken", "choose another name"))
    } else {
        None
    };
    match complaint {
        Some((message, help)) => Err(Issue::wrong_value(path, message)
            .with_value(format!("\"{name}\""))
            .with_help(help)),
        None => Ok(()),
    }
}
