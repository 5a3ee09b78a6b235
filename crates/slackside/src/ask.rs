//! From a verb with its options to its answer: model, study, document.

use crate::answer::Answer;
use crate::answers;
use crate::arguments::{Common, Question, ResponseArguments, Verb};
use crate::failure::Failure;
use slackside_model_file::{Document, ModelFileError};
use slackside_studies::{Signal, Study, Subject, execute};
use std::path::Path;

/// How a model file is read: from disk, or from what the program carries.
pub type Reader<'a> = &'a dyn Fn(&Path) -> Result<Document, ModelFileError>;

/// Runs the study that a verb asks for.
///
/// # Errors
/// [`Failure`]; [`Failure::NoAnswer`] of the verbs that read no model.
pub fn answer(verb: Verb, read: Reader, signal: &Signal) -> Result<Box<dyn Answer>, Failure> {
    match verb {
        Verb::Check(options) => {
            let subject = subject(&options.common, read)?;
            if subject.model.drive().is_some() {
                run(&options.drive_study(subject)?, signal)
            } else {
                run(&options.study(subject)?, signal)
            }
        }
        Verb::Modes(options) => {
            let subject = subject(&options.common, read)?;
            if subject.model.drive().is_some() {
                run(&options.drive_study(subject)?, signal)
            } else {
                run(&options.study(subject)?, signal)
            }
        }
        Verb::Simulate(options) => {
            let subject = subject(&options.common, read)?;
            run(&options.study(subject)?, signal)
        }
        Verb::Response(options) => response(options, read, signal),
        Verb::Sweep(options) => {
            let measure = options.measure.clone();
            let subject = subject(&options.common, read)?;
            let found = execute(&options.study(subject)?, signal)?;
            let answer = answers::sweep::SweepAnswer::new(found, measure.as_deref())?;
            Ok(Box::new(answer))
        }
        Verb::Limit(options) => {
            let subject = subject(&options.common, read)?;
            run(&options.study(subject)?, signal)
        }
        Verb::Basin(options) => {
            let subject = subject(&options.common, read)?;
            run(&options.study(subject)?, signal)
        }
        Verb::Figure(_) | Verb::Schema => Err(Failure::NoAnswer),
    }
}

/// Branches, the periodic motion at each value, the linear response by orders or a comparison of methods.
fn response(options: ResponseArguments, read: Reader, signal: &Signal) -> Result<Box<dyn Answer>, Failure> {
    let measure = options.measure.clone();
    let measure = measure.as_deref();
    let document = document(&options.common, read)?;
    let subject = Subject::new(&document)?;
    match options.question(&document, subject)? {
        Question::Comparison(study) => run(&study, signal),
        Question::Orders(study) => {
            let found = execute(&study, signal)?;
            let answer = answers::drive::DriveResponseAnswer::new(found, measure)?;
            Ok(Box::new(answer))
        }
        Question::Branches(study) => {
            let found = execute(&study, signal)?;
            let answer = answers::response::ResponseAnswer::new(found, measure)?;
            Ok(Box::new(answer))
        }
        Question::Periodic(study) => {
            let found = execute(&study, signal)?;
            let answer = answers::response::ResponseAnswer::new(found, measure)?;
            Ok(Box::new(answer))
        }
    }
}

/// Runs a study whose document is its answer.
fn run<S>(study: &S, signal: &Signal) -> Result<Box<dyn Answer>, Failure>
where
    S: Study,
    S::Document: Answer + 'static,
{
    Ok(Box::new(execute(study, signal)?))
}

/// The file with the overrides of the command line.
fn document(common: &Common, read: Reader) -> Result<Document, Failure> {
    let mut document = read(&common.file)?;
    for setting in &common.set {
        document.set(&setting.key, &setting.value)?;
    }
    Ok(document)
}

/// The model of the file with the overrides of the command line.
fn subject(common: &Common, read: Reader) -> Result<Subject, Failure> {
    Ok(Subject::new(&document(common, read)?)?)
}
