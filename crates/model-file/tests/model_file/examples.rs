//! Every file of the examples directory.

use slackside_model_file::Document;

use crate::example_files;

#[test]
fn every_example_is_a_sound_model_without_warnings() {
    for (name, text) in example_files() {
        let (model, warnings) = Document::parse(&name, &text).unwrap().model().unwrap();
        assert_eq!(warnings, [], "{name}");
        assert!(model.name().is_some(), "{name}");
        model.system().unwrap().check().unwrap();
    }
}

#[test]
fn every_example_says_what_it_is_and_names_its_command() {
    for (name, text) in example_files() {
        let mut lines = text.lines();
        let first = lines.next().unwrap();
        assert!(first.starts_with("# ") && first.ends_with('.'), "{name}");
        let command = lines.next().unwrap();
        assert!(command.starts_with("# slackside "), "{name}");
        assert!(command.contains(&format!(" examples/{name} ")), "{name}");
    }
}
