//! A histogram of durations in fixed memory, which one thread fills while others read.

use std::sync::atomic::{AtomicU64, Ordering};

/// Buckets to a power of two.
const STEPS: usize = 16;
/// Every duration below this has a bucket of its own; above, buckets are logarithmic.
const LINEAR: u64 = STEPS as u64;
const BUCKETS: usize = STEPS * (64 - 4 + 1);

/// Counts of durations in nanoseconds, in buckets no wider than a sixteenth of what they hold.
#[derive(Debug)]
pub struct Histogram {
    counts: Box<[AtomicU64; BUCKETS]>,
    max: AtomicU64,
}

/// What a histogram says: the median, what 99 of 100 durations stay within, and the longest, in nanoseconds. The
/// first two are upper ends of buckets, at most a sixteenth too long; the last is exact.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default)]
pub struct Quantiles {
    /// Half of the durations are no longer.
    pub p50: u64,
    /// 99 % of the durations are no longer.
    pub p99: u64,
    /// No duration is longer.
    pub max: u64,
}

impl Default for Histogram {
    fn default() -> Self {
        Self { counts: Box::new([const { AtomicU64::new(0) }; BUCKETS]), max: AtomicU64::new(0) }
    }
}

impl Histogram {
    /// Counts one duration. Only one thread may do so; this allocates nothing and never waits.
    pub fn record(&self, nanoseconds: u64) {
        let count = &self.counts[bucket(nanoseconds)];
        count.store(count.load(Ordering::Relaxed) + 1, Ordering::Relaxed);
        if nanoseconds > self.max.load(Ordering::Relaxed) {
            self.max.store(nanoseconds, Ordering::Relaxed);
        }
    }

    /// The quantiles of what was counted so far; all 0 where nothing was.
    pub fn quantiles(&self) -> Quantiles {
        let total = self.counts.iter().map(|count| count.load(Ordering::Relaxed)).sum();
        let max = self.max.load(Ordering::Relaxed);
        let within = |share: u64| self.within(u64_share(total, share)).min(max);
        Quantiles { p50: within(50), p99: within(99), max }
    }

    /// The upper end of the bucket in which the `rank`th shortest duration lies.
    fn within(&self, rank: u64) -> u64 {
        let mut seen = 0;
        for (index, count) in self.counts.iter().enumerate() {
            seen += count.load(Ordering::Relaxed);
            if seen >= rank {
                return upper_end(index);
            }
        }
        u64::MAX
    }
}

/// So many hundredths of a count, rounded up.
fn u64_share(total: u64, hundredths: u64) -> u64 {
    total / 100 * hundredths + (total % 100 * hundredths).div_ceil(100)
}

fn bucket(value: u64) -> usize {
    if value < LINEAR {
        return usize::try_from(value).unwrap_or(0);
    }
    // The leading one, and the four bits behind it.
    let power = value.ilog2() as usize;
    let step = usize::try_from(value >> (power - 4) & (LINEAR - 1)).unwrap_or(0);
    (power - 3) * STEPS + step
}

fn upper_end(bucket: usize) -> u64 {
    let (group, step) = (bucket / STEPS, (bucket % STEPS) as u64);
    if group == 0 { step } else { ((LINEAR + step) << (group - 1)) + ((1 << (group - 1)) - 1) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn buckets_cover_all_durations_without_gaps_and_are_narrow() {
        let mut next = 0u64;
        for index in 0..BUCKETS {
            let end = upper_end(index);
            assert_eq!((bucket(next), bucket(end)), (index, index));
            assert!(end - next <= next / 16, "{next}..={end}");
            next = end.wrapping_add(1);
        }
        assert_eq!(next, 0, "the last bucket ends with the largest duration");
    }

    #[test]
    fn quantiles_are_those_of_the_sorted_durations() {
        let histogram = Histogram::default();
        assert_eq!(histogram.quantiles(), Quantiles::default());
        // In an order that is not theirs: 1 to 1000 us.
        for index in 0..1000 {
            histogram.record((index * 7 % 1000 + 1) * 1000);
        }
        let Quantiles { p50, p99, max } = histogram.quantiles();
        assert!((500_000..=531_250).contains(&p50), "{p50}");
        assert!((990_000..=1_000_000).contains(&p99), "{p99}");
        assert_eq!(max, 1_000_000);
    }

    #[test]
    fn one_duration_is_every_quantile() {
        for duration in [0, 15, 16, 12_345, u64::MAX] {
            let histogram = Histogram::default();
            histogram.record(duration);
            assert_eq!(histogram.quantiles(), Quantiles { p50: duration, p99: duration, max: duration });
        }
    }
}
