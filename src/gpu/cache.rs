//! Passes that are built when they are first needed, and then shared.

use std::collections::HashMap;
use std::hash::Hash;
use std::sync::{Arc, Mutex, PoisonError};

use crate::gpu::error::GpuError;

/// Passes that are built once for each key.
#[derive(Debug)]
pub(super) struct Cache<K, T>(Mutex<HashMap<K, Arc<T>>>);

impl<K: Eq + Hash, T> Cache<K, T> {
    pub(super) fn get(&self, key: &K) -> Option<Arc<T>> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner).get(key).cloned()
    }

    /// Returns the passes for a key, and builds them if necessary. The lock is not held while they are built. If two
    /// threads build the passes for the same key, one of the two results is dropped.
    pub(super) async fn of(
        &self,
        key: K,
        build: impl Future<Output = Result<T, GpuError>>,
    ) -> Result<Arc<T>, GpuError> {
        if let Some(built) = self.get(&key) {
            return Ok(built);
        }
        let built = Arc::new(build.await?);
        let mut all = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        Ok(Arc::clone(all.entry(key).or_insert(built)))
    }
}

impl<K, T> Default for Cache<K, T> {
    fn default() -> Self {
        Self(Mutex::default())
    }
}
