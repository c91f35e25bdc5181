//! What a mistyped word was meant to be.

/// Longest word that is compared with others, in bytes, and most others that it is
/// compared with: a file with a million mistakes must not take hours.
const MAX_COMPARED_BYTES: usize = 32;
const MAX_COMPARED: usize = 100;

/// The candidate that `word` is a small slip or a part of, if there is one.
pub(super) fn nearest<'a>(
    word: &str,
    candidates: impl Iterator<Item = &'a str>,
) -> Option<&'a str> {
    let word = word.to_lowercase();
    if word.len() > MAX_COMPARED_BYTES {
        return None;
    }
    // No more than a third may differ, so that short words are not taken for others.
    let most = (word.len() / 3).min(2);
    candidates
        .take(MAX_COMPARED)
        .filter(|candidate| candidate.len() <= MAX_COMPARED_BYTES)
        .map(|candidate| {
            let part = word.len() >= 3 && candidate.contains(&word);
            (if part { 0 } else { edits(&word, candidate) }, candidate)
        })
        .filter(|&(edits, _)| edits <= most)
        .min_by_key(|&(edits, _)| edits)
        .map(|(_, candidate)| candidate)
}

/// Number of letters to insert, delete or replace to turn `a` into `b`.
fn edits(a: &str, b: &str) -> usize {
    // `row[j]` is the distance from the part of `a` read so far to the first j of `b`.
    let mut row: Vec<usize> = (0..=b.chars().count()).collect();
    for (i, from) in a.chars().enumerate() {
        let mut diagonal = std::mem::replace(&mut row[0], i + 1);
        for (j, to) in b.chars().enumerate() {
            let replace = diagonal + usize::from(from != to);
            diagonal = row[j + 1];
            row[j + 1] = replace.min(diagonal + 1).min(row[j] + 1);
        }
    }
    row[row.len() - 1]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn edits_of_known_words() {
        assert_eq!(edits("", "abc"), 3);
        assert_eq!(edits("kitten", "sitting"), 3);
        assert_eq!(edits("center", "centre"), 2);
    }
}
