//! The times of all scans, which the lanes have in common, and how far back each preset reaches.
//!
//! Scans count from 1; number 0 stands for the time 0, which is what a latch starts with. As long as no time is before
//! the one before it, nor below 0, `now - start >= PT` holds for a start in some scan only if it holds for a start in
//! every earlier one: differences of such times do not overflow, and they only shrink from one scan to the next. So for
//! each preset there is one number, the last scan for which it holds, and it never goes back. This is exact, whatever
//! the steps between the times are. A time that does go back is refused: see [`History::accepts`].

/// Scans that can be told apart; the next one is refused.
const MOST_SCANS: u64 = u32::MAX as u64;

/// Scans with equal steps between their times.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
struct Run {
    first: u64,
    time: i64,
    step: i64,
}

/// How far back a preset reaches.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
struct Reach {
    preset: i64,
    /// One past the last scan that is at least as long ago as the preset.
    end: u64,
    /// The time of scan `end`, and the run that it is in, once it was looked up.
    start: Option<i64>,
    run: usize,
    /// Whether it goes on by one scan with each that comes after an equal step. Else it has not begun to.
    goes_on: bool,
}

/// See the module.
#[derive(Clone, PartialEq, Eq, Debug)]
pub(super) struct History {
    runs: Vec<Run>,
    /// The last scan, and its time.
    last: u64,
    now: i64,
    reaches: Vec<Reach>,
    /// How many scans the presets that go on have gone on since `end` was noted, all by one a scan.
    ahead: u64,
    /// While steps stay equal and no time comes that is as late as this, each preset goes on by one scan, or stays.
    steady_before: Option<i64>,
    /// Whether each preset went on with the last scan as was to be foreseen.
    went_on: bool,
}

impl History {
    /// Before the first scan, for some presets in nanoseconds.
    pub(super) fn new(presets: impl Iterator<Item = i64>) -> Self {
        let reach = |preset: i64| Reach { preset, end: 0, start: Some(0), run: 0, goes_on: false };
        let (runs, reaches) = (vec![Run { first: 0, time: 0, step: 0 }], presets.map(reach).collect());
        Self { runs, last: 0, now: 0, reaches, ahead: 0, steady_before: None, went_on: false }
    }

    /// Whether the next scan may happen at a time: not before the last one.
    pub(super) fn accepts(&self, now: i64) -> bool {
        now >= self.now && self.last < MOST_SCANS
    }

    /// The scan that came last, from 1; 0 before the first.
    pub(super) fn last(&self) -> u64 {
        self.last
    }

    /// Adds a scan, at a time that it [accepts](History::accepts); gives its number. Every preset then reaches as far
    /// back from it as it does.
    pub(super) fn begin(&mut self, now: i64) -> u64 {
        let step = now - self.now;
        let run = self.runs[self.runs.len() - 1];
        if run.step == step && self.last > run.first && self.steady_before.is_some_and(|before| now < before) {
            (self.last, self.now, self.ahead) = (self.last + 1, now, self.ahead + 1);
            self.went_on = true;
            return self.last;
        }
        self.went_on = false;
        self.look_at_all(now);
        self.last += 1;
        let end = self.runs.len() - 1;
        if self.last == self.runs[end].first + 1 {
            self.runs[end].step = step;
        } else if self.runs[end].step != step {
            self.runs.push(Run { first: self.last, time: now, step: 0 });
        }
        self.now = now;
        self.foresee();
        self.last
    }

    /// Finds how far back each preset reaches from a time.
    fn look_at_all(&mut self, now: i64) {
        let Self { runs, last, reaches, ahead, .. } = self;
        let ahead = std::mem::take(ahead);
        for reach in reaches {
            if ahead > 0 && reach.goes_on {
                (reach.end, reach.start) = (reach.end + ahead, None);
            }
            while reach.end <= *last {
                let start = *reach.start.get_or_insert_with(|| {
                    while runs.get(reach.run + 1).is_some_and(|run| run.first <= reach.end) {
                        reach.run += 1;
                    }
                    runs[reach.run].at(reach.end)
                });
                if now - start < reach.preset {
                    break;
                }
                (reach.end, reach.start) = (reach.end + 1, None);
            }
        }
    }

    /// Finds out whether the next scans, after equal steps, need no look at each preset: one goes on by one scan with
    /// each
    /// of them once the last scan that it reaches is in the run of equal steps, since `now - start` is then the same
    /// for both; one that reaches no scan yet stays until its time comes.
    fn foresee(&mut self) {
        let run = self.runs[self.runs.len() - 1];
        let mut before = i64::MAX;
        for reach in &mut self.reaches {
            // Scan 0 is at the time 0.
            reach.goes_on = reach.end > run.first;
            if !reach.goes_on {
                if reach.end > 0 {
                    self.steady_before = None;
                    return;
                }
                before = before.min(reach.preset);
            }
        }
        self.steady_before = Some(before);
    }

    /// The scans, from 0, that are at least as long ago as a preset: all before this number.
    pub(super) fn reach(&self, preset: usize) -> u64 {
        let Reach { end, goes_on, .. } = self.reaches[preset];
        if goes_on { end + self.ahead } else { end }
    }

    /// Whether a preset is to reach one scan further with each that comes; else it is to reach as far as now. It does
    /// as long as every scan [went on](History::went_on) like that.
    pub(super) fn goes_on(&self, preset: usize) -> bool {
        self.reaches[preset].goes_on
    }

    /// Whether every preset reached as far with the last scan as was to be foreseen before it.
    pub(super) fn went_on(&self) -> bool {
        self.went_on
    }

    /// The time of a scan that has been.
    pub(super) fn time(&self, scan: u64) -> i64 {
        self.runs[self.runs.partition_point(|run| run.first <= scan) - 1].at(scan)
    }
}

impl Run {
    /// The time of a scan of this run.
    fn at(self, scan: u64) -> i64 {
        self.time + self.step * i64::try_from(scan - self.first).unwrap_or(i64::MAX)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Runs scans at some times and compares with what the definition says.
    fn agrees(presets: &[i64], times: &[i64]) {
        let mut history = History::new(presets.iter().copied());
        let mut all = vec![0];
        for now in times {
            assert!(history.accepts(*now));
            let foreseen: Vec<u64> =
                (0..presets.len()).map(|index| history.reach(index) + u64::from(history.goes_on(index))).collect();
            let scan = history.begin(*now);
            assert_eq!(scan, all.len() as u64);
            for (index, preset) in presets.iter().enumerate() {
                let long_ago = all.iter().take_while(|time| now - **time >= *preset).count();
                assert_eq!(history.reach(index), long_ago as u64, "{preset} ns before {now} of {times:?}");
                assert!(!history.went_on() || history.reach(index) == foreseen[index], "{preset}, {now} of {times:?}");
            }
            all.push(*now);
            assert!((0..).zip(&all).all(|(scan, time)| history.time(scan) == *time), "{times:?}");
        }
    }

    #[test]
    fn each_preset_reaches_back_to_the_scans_that_are_as_long_ago() {
        let presets = [i64::MIN, -1, 0, 1, 2, 10, 30, 1000, i64::MAX];
        agrees(&presets, &[0, 10, 20, 30, 40, 50, 60, 70]);
        agrees(&presets, &[5, 5, 5, 6, 7, 8, 30, 30, 1000, 1010, 1020, 1030]);
        agrees(&presets, &[1 << 62, 1 << 62, i64::MAX - 1, i64::MAX, i64::MAX]);
        let mut time = 0;
        let irregular: Vec<i64> = (0..300usize)
            .map(|scan| {
                time += [0, 1, 1, 1, 7, 10, 10, 10, 400][scan * scan % 17 % 9];
                time
            })
            .collect();
        agrees(&presets, &irregular);
    }

    #[test]
    fn a_time_before_the_last_is_not_accepted() {
        let mut history = History::new([].into_iter());
        assert!(!history.accepts(-1));
        history.begin(10);
        assert!(history.accepts(10) && !history.accepts(9));
    }
}
