//! Decisions of a kernel that bounds leave open: either way is legal. A stage is followed once for every
//! combination of them, until one leads to what the device did.

/// More combinations are not tried.
const MOST: u32 = 512;

/// One combination after another.
#[derive(Debug, Default)]
pub(super) struct Choices {
    /// Of each open decision in turn, which way is gone, and how many there are.
    taken: Vec<[u32; 2]>,
    next: usize,
    tried: u32,
}

impl Choices {
    /// What was decided, or one way after the other.
    pub(super) fn decide(&mut self, certain: Option<bool>) -> bool {
        certain.unwrap_or_else(|| self.choose(2) == 1)
    }

    /// One of the whole numbers from one to another, which are not many.
    pub(super) fn pick(&mut self, [low, high]: [f64; 2]) -> f64 {
        let count = (high - low).clamp(0.0, 64.0) as u32 + 1;
        if count == 1 { low } else { low + f64::from(self.choose(count)) }
    }

    fn choose(&mut self, count: u32) -> u32 {
        if self.next == self.taken.len() {
            self.taken.push([0, count]);
        }
        let [way, _] = self.taken[self.next];
        self.next += 1;
        way
    }

    /// Goes on to the next combination; false if there is none.
    pub(super) fn advance(&mut self) -> bool {
        self.taken.truncate(self.next);
        self.next = 0;
        self.tried += 1;
        while let Some([way, count]) = self.taken.pop() {
            if way + 1 < count {
                self.taken.push([way + 1, count]);
                return self.tried < MOST;
            }
        }
        false
    }

    /// Whether anything was open.
    pub(super) fn were_open(&self) -> bool {
        self.tried > 0 || self.next > 0
    }

    /// Whether combinations were left out.
    pub(super) fn were_too_many(&self) -> bool {
        self.tried >= MOST
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
            // Only one way leads to a second decision.
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
