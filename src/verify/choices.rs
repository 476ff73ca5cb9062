//! Decisions of a kernel that error bounds leave open, so that both outcomes are legal. A stage is evaluated once for
//! every combination of outcomes, until one combination leads to the device's result.

/// The largest number of combinations that are tried.
const MAX: u32 = 512;

/// Enumerates the combinations of outcomes.
#[derive(Debug, Default)]
pub(super) struct Choices {
    /// For each open decision in turn: the current outcome, and the number of outcomes.
    taken: Vec<[u32; 2]>,
    next: usize,
    tried: u32,
}

impl Choices {
    /// Returns a certain outcome, or for an open decision the outcome of the current combination.
    pub(super) fn decide(&mut self, certain: Option<bool>) -> bool {
        certain.unwrap_or_else(|| self.choose(2) == 1)
    }

    /// Returns one of the whole numbers from `low` to `high`, of which there must be few.
    pub(super) fn pick(&mut self, [low, high]: [f64; 2]) -> f64 {
        let count = (high - low).clamp(0.0, 64.0) as u32 + 1;
        if count == 1 { low } else { low + f64::from(self.choose(count)) }
    }

    fn choose(&mut self, count: u32) -> u32 {
        if self.next == self.taken.len() {
            self.taken.push([0, count]);
        }
        let [outcome, _] = self.taken[self.next];
        self.next += 1;
        outcome
    }

    /// Moves on to the next combination. Returns `false` if there is none.
    pub(super) fn advance(&mut self) -> bool {
        self.taken.truncate(self.next);
        self.next = 0;
        self.tried += 1;
        while let Some([outcome, count]) = self.taken.pop() {
            if outcome + 1 < count {
                self.taken.push([outcome + 1, count]);
                return self.tried < MAX;
            }
        }
        false
    }

    /// Whether any decision was open.
    pub(super) fn were_open(&self) -> bool {
        self.tried > 0 || self.next > 0
    }

    /// Whether combinations were left out because there are too many.
    pub(super) fn were_too_many(&self) -> bool {
        self.tried >= MAX
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_combination_comes_once() {
        let mut choices = Choices::default();
        let mut seen = Vec::new();
        loop {
            let first = choices.decide(None);
            // Only one outcome leads to a second decision.
            let second = if first { choices.pick([3.0, 5.0]) } else { 0.0 };
            assert!(choices.decide(Some(true)));
            seen.push((first, second));
            if !choices.advance() {
                break;
            }
        }
        assert_eq!(seen, [(false, 0.0), (true, 3.0), (true, 4.0), (true, 5.0)]);
        assert!(choices.were_open() && !choices.were_too_many());
    }
}
