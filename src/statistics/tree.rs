//! A fixed tree: what is merged with what depends on positions alone, so that the last bits do too.

/// Merges items that come in order, as a binary counter does: two neighbours of one size make one of twice the size.
#[derive(Debug)]
pub struct Tree<T, M: Fn(&mut T, &T)> {
    /// Complete subtrees, the largest first, each with its level.
    subtrees: Vec<(u32, T)>,
    merge: M,
}

impl<T, M: Fn(&mut T, &T)> Tree<T, M> {
    /// An empty tree; `merge` takes the second, later item into the first.
    pub fn new(merge: M) -> Self {
        Self { subtrees: Vec::new(), merge }
    }

    /// Adds the next item.
    pub fn push(&mut self, item: T) {
        self.subtrees.push((0, item));
        while let [.., (left, _), (right, _)] = self.subtrees[..]
            && left == right
        {
            self.merge_last_two();
        }
    }

    /// Merges what is left, from the end.
    pub fn finish(mut self) -> Option<T> {
        while self.subtrees.len() > 1 {
            self.merge_last_two();
        }
        self.subtrees.pop().map(|(_, item)| item)
    }

    fn merge_last_two(&mut self) {
        let Some((_, right)) = self.subtrees.pop() else { return };
        if let Some((level, left)) = self.subtrees.last_mut() {
            (self.merge)(left, &right);
            *level += 1;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn neighbours_of_one_size_are_merged() {
        let mut tree = Tree::new(|a: &mut String, b: &String| *a = format!("({a}{b})"));
        "abcdefg".chars().for_each(|c| tree.push(c.to_string()));
        assert_eq!(tree.finish().as_deref(), Some("(((ab)(cd))((ef)g))"));
        assert_eq!(Tree::new(|_: &mut u8, _: &u8| ()).finish(), None);
    }
}
