//! Why a study gives no answer.

use slackside_dynamics::flow::FlowError;
use slackside_linalg::LinalgError;
use slackside_mechanics::OutsideDomain;
use slackside_model_file::ModelFileError;

/// Why a study gives no answer.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum StudyError {
    /// The model is wrong, or a value that the study needs makes it wrong.
    #[error(transparent)]
    Model(#[from] ModelFileError),
    /// The question is wrong: an option, or a combination of options and model.
    #[error("{option}: {message}")]
    Question {
        /// The option as users write it, for example `--over`.
        option: String,
        /// What is wrong and what to do.
        message: String,
    },
    /// The parameter describes no system.
    #[error(transparent)]
    OutsideDomain(#[from] OutsideDomain),
    /// The motion cannot be computed.
    #[error(transparent)]
    Flow(#[from] FlowError),
    /// A linear-algebra call failed.
    #[error("linear algebra: {0}")]
    Linalg(#[from] LinalgError),
    /// The question is sound but has no answer.
    #[error("{0}")]
    NoAnswer(String),
    /// The study was interrupted before anything was finished.
    #[error("interrupted before anything was finished")]
    Interrupted,
}

impl StudyError {
    /// A wrong option.
    pub fn question(option: impl Into<String>, message: impl Into<String>) -> Self {
        Self::Question {
            option: option.into(),
            message: message.into(),
        }
    }

    /// Whether the user's input is wrong; otherwise the question has no answer.
    pub fn is_input(&self) -> bool {
        matches!(self, Self::Model(_) | Self::Question { .. })
    }
}
