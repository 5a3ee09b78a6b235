//! The known word that a mistyped one most likely meant.

/// The candidate nearest to `word`, if one is near enough to be worth suggesting.
pub(crate) fn nearest<'a>(word: &str, candidates: impl IntoIterator<Item = &'a str>) -> Option<&'a str> {
    /// Below this similarity a suggestion confuses more than it helps.
    const LEAST_SIMILARITY: f64 = 0.7;
    let lowercase = word.to_lowercase();
    candidates
        .into_iter()
        .map(|candidate| {
            let similarity = strsim::jaro_winkler(&lowercase, &candidate.to_lowercase());
            (similarity, candidate)
        })
        .filter(|(similarity, _)| *similarity >= LEAST_SIMILARITY)
        .max_by(|left, right| left.0.total_cmp(&right.0))
        .map(|(_, candidate)| candidate)
}

/// Words for a message: `a`, `a and b`, `a, b and c`.
pub(crate) fn enumerate<'a>(words: impl IntoIterator<Item = &'a str>) -> String {
    let words: Vec<&str> = words.into_iter().collect();
    match words.split_last() {
        None => String::new(),
        Some((last, [])) => (*last).to_owned(),
        Some((last, others)) => format!("{} and {last}", others.join(", ")),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_mistyped_word_finds_its_neighbour() {
        let known = ["preload", "belt_stiffness", "clutch_stiffness"];
        assert_eq!(nearest("pre_load", known), Some("preload"));
        assert_eq!(nearest("clutch_stifness", known), Some("clutch_stiffness"));
        assert_eq!(nearest("xyz", known), None);
    }

    #[test]
    fn words_are_joined_as_in_a_sentence() {
        assert_eq!(enumerate(["a"]), "a");
        assert_eq!(enumerate(["a", "b", "c"]), "a, b and c");
    }
}
