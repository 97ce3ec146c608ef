//! Work on all cores: many independent pieces, and results that do not depend on how many cores there are.

use std::num::NonZero;
use std::sync::atomic::{AtomicUsize, Ordering};

/// Does something for each of so many pieces, by their numbers, on all cores; gives the results in order. Each core
/// starts
/// with something of its own, as memory to work in.
///
/// # Panics
/// When the work does.
pub(crate) fn each<S, R: Send>(
    count: usize,
    start: impl Fn() -> S + Sync,
    work: impl Fn(&mut S, usize) -> R + Sync,
) -> Vec<R> {
    let workers = std::thread::available_parallelism().map_or(1, NonZero::get).min(count);
    let next = AtomicUsize::new(0);
    let run = || {
        let (mut own, mut done) = (start(), Vec::new());
        loop {
            let index = next.fetch_add(1, Ordering::Relaxed);
            if index >= count {
                return done;
            }
            done.push((index, work(&mut own, index)));
        }
    };
    let mut done = if workers <= 1 {
        run()
    } else {
        std::thread::scope(|scope| {
            let others: Vec<_> = (1..workers).map(|_| scope.spawn(run)).collect();
            let mut done = run();
            for other in others {
                match other.join() {
                    Ok(more) => done.extend(more),
                    Err(panic) => std::panic::resume_unwind(panic),
                }
            }
            done
        })
    };
    done.sort_unstable_by_key(|(index, _)| *index);
    done.into_iter().map(|(_, result)| result).collect()
}

#[cfg(test)]
mod tests {
    use super::each;

    #[test]
    fn every_piece_is_done_once_and_results_are_in_order() {
        for count in [0, 1, 2, 1000] {
            let squares: Vec<usize> = each(count, || 1, |one, index| index * index * *one);
            assert_eq!(squares, (0..count).map(|index| index * index).collect::<Vec<_>>());
        }
    }
}
