//! Thread pools: one per (process, thread count), built at first use, shared, never dropped.
//!
//! rayon's global pool is not used: a forked child that enters it hangs for ever, because its
//! threads did not survive the fork. Here a pool belongs to the process that built it; a child finds
//! none of its own and builds one. The list is lock-free, so that a fork at any moment leaves the
//! child no lock that nobody will open.

use crate::error::InputError;
use rayon::ThreadPool;
use std::sync::OnceLock;
use std::sync::atomic::{AtomicPtr, Ordering};

/// Most threads a batch may ask for.
pub const MAX_THREADS: usize = 256;
/// Batches of fewer players are stepped on the caller's thread: waking a pool costs more.
pub const INLINE_BELOW: usize = 512;

struct Node {
    process: u32,
    threads: usize,
    pool: OnceLock<ThreadPool>,
    next: *mut Node,
}

static POOLS: AtomicPtr<Node> = AtomicPtr::new(core::ptr::null_mut());

fn find(mut at: *mut Node, process: u32, threads: usize) -> Option<&'static Node> {
    // SAFETY: nodes are leaked and, once published, never changed but for their OnceLock.
    while let Some(node) = unsafe { at.as_ref() } {
        if node.process == process && node.threads == threads {
            return Some(node);
        }
        at = node.next;
    }
    None
}

fn node(threads: usize) -> &'static Node {
    let process = std::process::id();
    let mut fresh: Option<Box<Node>> = None;
    loop {
        let head = POOLS.load(Ordering::Acquire);
        if let Some(node) = find(head, process, threads) {
            return node;
        }
        let mut new = fresh
            .take()
            .unwrap_or_else(|| Box::new(Node { process, threads, pool: OnceLock::new(), next: head }));
        new.next = head;
        let raw = Box::into_raw(new);
        if POOLS.compare_exchange(head, raw, Ordering::AcqRel, Ordering::Acquire).is_ok() {
            // SAFETY: just published, never freed.
            return unsafe { &*raw };
        }
        // SAFETY: not published, so still ours alone.
        fresh = Some(unsafe { Box::from_raw(raw) });
    }
}

/// The pool of this process with that many threads.
///
/// # Errors
/// If the threads cannot be started.
pub(super) fn pool(threads: usize) -> Result<&'static ThreadPool, InputError> {
    let node = node(threads);
    if let Some(pool) = node.pool.get() {
        return Ok(pool);
    }
    let pool = rayon::ThreadPoolBuilder::new()
        .num_threads(threads)
        .thread_name(|i| format!("discjump-{i}"))
        .build()
        .map_err(|e| InputError(format!("threads: {threads} threads could not be started: {e}")))?;
    Ok(node.pool.get_or_init(|| pool))
}

/// The number of threads to use: the one asked for, or one per core.
///
/// # Errors
/// If it is 0 or more than [`MAX_THREADS`].
pub(super) fn resolve_threads(threads: Option<usize>) -> Result<usize, InputError> {
    match threads {
        Some(n) if (1..=MAX_THREADS).contains(&n) => Ok(n),
        Some(n) => Err(InputError(format!("threads: expected 1 to {MAX_THREADS}, got {n}"))),
        None => Ok(std::thread::available_parallelism().map_or(1, usize::from).min(MAX_THREADS)),
    }
}
