//! The `slackside` program: it translates options into studies and their answers into tables, figures and JSON.

mod answer;
mod answers;
mod arguments;
mod ask;
mod directory;
mod failure;
mod figure;
mod plots;
mod session;
mod table_text;

use arguments::{Arguments, Verb};
use clap::Parser;
use failure::Failure;
use session::Session;
use slackside_model_file::Document;
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
    let verb = match verb {
        Verb::Schema => return answer::print(&format!("{:#}\n", slackside_model_file::schema())),
        Verb::Figure(options) => return figure::run(&options),
        verb => verb,
    };
    let common = verb.common().cloned().ok_or(Failure::NoAnswer)?;
    let session = Session::open(common.threads, common.quiet)?;
    let answer = ask::answer(verb, &Document::read, &session.signal())?;
    session.close();
    answer::give(answer.as_ref(), &common)
}
