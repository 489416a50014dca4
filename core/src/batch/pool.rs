//! Thread pools: one per (process, thread count), built at first use, shared, never dropped.
//!
//! rayon's global pool is not used: a forked child that enters it hangs for ever, because its
//! threads did not survive the fork. Here a pool belongs to the process that built it; a child finds
//! none of its own and builds one. The list is lock-free, so that a fork at any moment leaves the
//! child no lock that nobody will open.

use crate::error::InputError;
use rayon::ThreadPool;
use std::sync::atomic::{AtomicBool, AtomicPtr, AtomicUsize, Ordering};
use std::sync::{Mutex, OnceLock, PoisonError};

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
fn pool(threads: usize) -> Result<&'static ThreadPool, InputError> {
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

/// Looks at the others' work before the caller goes to sleep: about as long as a piece takes.
const LOOKS: u32 = 2000;

/// Says, also after a panic, that a thread has no more work.
struct Done<'a>(&'a AtomicUsize);

impl Drop for Done<'_> {
    fn drop(&mut self) {
        self.0.fetch_sub(1, Ordering::Relaxed);
    }
}

/// Who steps a batch: the caller's thread, and a pool beside it where that pays.
#[derive(Clone, Copy)]
pub(super) struct Crew {
    pool: Option<&'static ThreadPool>,
    threads: usize,
}

impl Crew {
    /// For a batch of so many players.
    ///
    /// # Errors
    /// If the threads cannot be started.
    pub(super) fn new(threads: usize, players: usize) -> Result<Self, InputError> {
        let alone = threads == 1 || players < INLINE_BELOW;
        Ok(Self { pool: if alone { None } else { Some(pool(threads - 1)?) }, threads })
    }

    /// Does the work on every piece. Whoever is free takes the next one; the caller works too, from the
    /// first moment on, while the pool's threads wake up. The caller asks `go_on` after each of his pieces;
    /// where the answer is no, no more pieces are begun. Returns whether all were.
    pub(super) fn share<P: Send>(
        self,
        mut pieces: impl ExactSizeIterator<Item = P> + Send,
        work: impl Fn(P) + Sync,
        go_on: &mut dyn FnMut() -> bool,
    ) -> bool {
        let helpers = (self.threads - 1).min(pieces.len().saturating_sub(1));
        let Some(pool) = self.pool.filter(|_| helpers > 0) else {
            while let Some(piece) = pieces.next() {
                work(piece);
                if pieces.len() > 0 && !go_on() {
                    return false;
                }
            }
            return true;
        };
        let pieces = Mutex::new(pieces);
        let at_work = AtomicUsize::new(0);
        // The lock is held for the taking only, and nothing panics under it.
        let next = || pieces.lock().unwrap_or_else(PoisonError::into_inner).next();
        let stopped = AtomicBool::new(false);
        pool.in_place_scope(|scope| {
            for _ in 0..helpers {
                scope.spawn(|_| {
                    at_work.fetch_add(1, Ordering::Relaxed);
                    let _done = Done(&at_work);
                    while !stopped.load(Ordering::Relaxed)
                        && let Some(piece) = next()
                    {
                        work(piece);
                    }
                });
            }
            while let Some(piece) = next() {
                work(piece);
                if !go_on() {
                    stopped.store(true, Ordering::Relaxed);
                    break;
                }
            }
            // The others are in their last pieces: to sleep and be woken would take longer than they do.
            let mut looks = 0;
            while at_work.load(Ordering::Relaxed) > 0 && looks < LOOKS {
                core::hint::spin_loop();
                looks += 1;
            }
        });
        !stopped.load(Ordering::Relaxed) || next().is_none()
    }
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
