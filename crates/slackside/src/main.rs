//! The `slackside` program: it translates options into studies and their answers into tables, figures and JSON.

mod answer;
mod answers;
mod arguments;
mod directory;
mod failure;
mod plots;
mod session;
mod table_text;

use arguments::{Arguments, Common, Question, ResponseArguments, Verb};
use clap::Parser;
use failure::Failure;
use session::Session;
use slackside_model_file::Document;
use slackside_studies::{Study, Subject, execute};
use std::process::ExitCode;

fn main() -> ExitCode {
    let arguments = Arguments::parse();
    match run(arguments.verb) {
        Ok(()) => ExitCode::SUCCESS,
        Err(failure) => {
            failure.print();
            ExitCode::from(failure.status())
        }
    }
}

fn run(verb: Verb) -> Result<(), Failure> {
    match verb {
        Verb::Check(options) => {
            let common = options.common.clone();
            let subject = subject(&common)?;
            if subject.model.drive().is_some() {
                answer_to(&common, &options.drive_study(subject)?)
            } else {
                answer_to(&common, &options.study(subject)?)
            }
        }
        Verb::Modes(options) => {
            let common = options.common.clone();
            let subject = subject(&common)?;
            if subject.model.drive().is_some() {
                answer_to(&common, &options.drive_study(subject)?)
            } else {
                answer_to(&common, &options.study(subject)?)
            }
        }
        Verb::Simulate(options) => ask(&options.common.clone(), |subject| options.study(subject)),
        Verb::Response(options) => response(options),
        Verb::Sweep(options) => {
            let measure = options.measure.clone();
            let common = options.common.clone();
            let study = options.study(subject(&common)?)?;
            let session = Session::open(&common)?;
            let document = execute(&study, &session.signal())?;
            let answer = answers::sweep::SweepAnswer::new(document, measure.as_deref())?;
            session.close();
            answer::give(&answer, &common)
        }
        Verb::Limit(options) => ask(&options.common.clone(), |subject| options.study(subject)),
        Verb::Basin(options) => ask(&options.common.clone(), |subject| options.study(subject)),
        Verb::Schema => answer::print(&format!("{:#}\n", slackside_model_file::schema())),
    }
}

/// Branches, the periodic motion at each value, the linear response by orders or a comparison of methods.
fn response(options: ResponseArguments) -> Result<(), Failure> {
    let (common, measure) = (options.common.clone(), options.measure.clone());
    let measure = measure.as_deref();
    let document = document(&common)?;
    let subject = Subject::new(&document)?;
    match options.question(&document, subject)? {
        Question::Comparison(study) => answer_to(&common, &study),
        Question::Orders(study) => {
            let found = run_study(&common, &study)?;
            let answer = answers::drive::DriveResponseAnswer::new(found, measure)?;
            answer::give(&answer, &common)
        }
        Question::Branches(study) => {
            let found = run_study(&common, &study)?;
            let answer = answers::response::ResponseAnswer::new(found, measure)?;
            answer::give(&answer, &common)
        }
        Question::Periodic(study) => {
            let found = run_study(&common, &study)?;
            let answer = answers::response::ResponseAnswer::new(found, measure)?;
            answer::give(&answer, &common)
        }
    }
}

/// Runs a study with progress and interruption.
fn run_study<S: Study>(common: &Common, study: &S) -> Result<S::Document, Failure> {
    let session = Session::open(common)?;
    let document = execute(study, &session.signal());
    session.close();
    Ok(document?)
}

/// Reads the model, runs the study and gives its answer.
fn ask<S>(common: &Common, study: impl FnOnce(Subject) -> Result<S, Failure>) -> Result<(), Failure>
where
    S: Study,
    S::Document: answer::Answer,
{
    answer_to(common, &study(subject(common)?)?)
}

/// Runs a study and gives its answer.
fn answer_to<S>(common: &Common, study: &S) -> Result<(), Failure>
where
    S: Study,
    S::Document: answer::Answer,
{
    let session = Session::open(common)?;
    let document = execute(study, &session.signal())?;
    session.close();
    answer::give(&document, common)
}

/// The file with the overrides of the command line.
fn document(common: &Common) -> Result<Document, Failure> {
    let mut document = Document::read(&common.file)?;
    for setting in &common.set {
        document.set(&setting.key, &setting.value)?;
    }
    Ok(document)
}

/// The model of the file with the overrides of the command line.
fn subject(common: &Common) -> Result<Subject, Failure> {
    Ok(Subject::new(&document(common)?)?)
}
