//! "Did you mean": the name that a misspelt one is nearest to. It must never cost more than a fixed amount a run.

/// The longest name that is compared, in bytes.
const LONGEST: usize = 64;

/// Pairs of letters that may still be compared in one run; after that there are no more suggestions.
pub(crate) struct Budget(usize);

impl Default for Budget {
    fn default() -> Self {
        Self(10_000_000)
    }
}

/// The candidate nearest to a name, if one is near enough: a third of the name's letters may differ, at most two.
/// Of equally near ones the first.
pub(crate) fn nearest<'a>(
    name: &str,
    candidates: impl Iterator<Item = &'a str>,
    budget: &mut Budget,
) -> Option<&'a str> {
    let limit = (name.len() / 3).min(2);
    if limit == 0 || name.len() > LONGEST {
        return None;
    }
    let mut best = None;
    for candidate in candidates {
        budget.0 = budget.0.checked_sub(1)?;
        if candidate.len() <= LONGEST && candidate.len().abs_diff(name.len()) <= limit {
            budget.0 = budget.0.checked_sub(name.len() * candidate.len())?;
            let distance = distance(name.as_bytes(), candidate.as_bytes());
            if distance <= limit && best.is_none_or(|(least, _)| distance < least) {
                best = Some((distance, candidate));
            }
        }
    }
    best.map(|(_, candidate)| candidate)
}

/// How many letters must be put in, left out, replaced or swapped with their neighbour. ASCII letters are compared
/// without regard to case. Neither name may be longer than [`LONGEST`].
fn distance(a: &[u8], b: &[u8]) -> usize {
    let same = |x: u8, y: u8| x.eq_ignore_ascii_case(&y);
    let mut rows = [[0; LONGEST + 1]; 3];
    for (column, cell) in rows[0].iter_mut().enumerate() {
        *cell = column;
    }
    let [mut above, mut row, mut spare] = rows;
    for i in 1..=a.len() {
        row[0] = i;
        for j in 1..=b.len() {
            let replaced = above[j - 1] + usize::from(!same(a[i - 1], b[j - 1]));
            row[j] = replaced.min(above[j] + 1).min(row[j - 1] + 1);
            if i > 1 && j > 1 && same(a[i - 1], b[j - 2]) && same(a[i - 2], b[j - 1]) {
                row[j] = row[j].min(spare[j - 2] + 1);
            }
        }
        (spare, above, row) = (above, row, spare);
    }
    above[b.len()]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_letter_or_a_swap_is_one_step() {
        let pairs = [("motor", "motor", 0), ("motor", "Motr", 1), ("motor", "mootor", 1), ("motor", "motro", 1)];
        for (a, b, steps) in pairs {
            assert_eq!(distance(a.as_bytes(), b.as_bytes()), steps, "{a} {b}");
        }
        assert_eq!(distance(b"start", b"stop"), 3);
        assert_eq!(distance(b"", b"abc"), 3);
    }

    #[test]
    fn the_nearest_name_is_suggested_and_none_that_is_far() {
        let names = ["start", "stop", "pump", "pumps"];
        let nearest = |name| nearest(name, names.into_iter(), &mut Budget::default());
        assert_eq!(nearest("PUPMS"), Some("pumps"));
        assert_eq!(nearest("strat"), Some("start"));
        assert_eq!(nearest("valve"), None);
        assert_eq!(nearest("x"), None);
    }

    #[test]
    fn a_spent_budget_suggests_nothing() {
        assert_eq!(nearest("strat", ["start"].into_iter(), &mut Budget(25)), None);
    }
}
