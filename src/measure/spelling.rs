//! The word that a misspelt one was meant to be.

/// Longest word in bytes that can be a misspelt one.
const LONGEST: usize = 100;

/// The nearest of the known words, or none where none is near. Capital letters do not matter.
///
/// ```
/// use freeplay::measure::spelling::nearest;
///
/// assert_eq!(nearest("clearence", &["radius", "clearance"]), Some("clearance"));
/// assert_eq!(nearest("mass", &["radius", "clearance"]), None);
/// ```
pub fn nearest<'a>(stranger: &str, known: &[&'a str]) -> Option<&'a str> {
    // No word of ours is so long, and to compare is work.
    if stranger.len() > LONGEST {
        return None;
    }
    // 0.8 accepts a wrong, missing or swapped letter or two and refuses unrelated words.
    let stranger = stranger.to_lowercase();
    known
        .iter()
        .map(|name| (strsim::jaro_winkler(&stranger, &name.to_lowercase()), *name))
        .filter(|(similarity, _)| *similarity > 0.8)
        .max_by(|a, b| a.0.total_cmp(&b.0))
        .map(|(_, name)| name)
}
