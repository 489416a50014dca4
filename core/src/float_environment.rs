//! The floating-point environment of the thread that steps: round to nearest, nothing flushed to zero.
//!
//! A library may have changed it on the caller's thread (torch can flush denormals) but not on the
//! pool's, and then the bits would depend on which thread stepped a player. Guarded on x86-64; on other
//! processors nothing is set, and a caller who changed the environment gets other bits.

/// Holds the default environment until dropped.
pub(crate) struct DefaultFloats {
    #[cfg(target_arch = "x86_64")]
    before: u32,
}

/// MXCSR after reset: all exceptions masked, round to nearest, no flushing.
#[cfg(target_arch = "x86_64")]
const MXCSR_DEFAULT: u32 = 0x1f80;

impl DefaultFloats {
    /// Sets the default environment on this thread.
    pub(crate) fn enter() -> Self {
        #[cfg(target_arch = "x86_64")]
        {
            let mut before = 0u32;
            // SAFETY: stores the control register into a local.
            unsafe { core::arch::asm!("stmxcsr [{}]", in(reg) &raw mut before, options(nostack)) };
            if before & !0x3f != MXCSR_DEFAULT {
                load(MXCSR_DEFAULT);
            }
            Self { before }
        }
        #[cfg(not(target_arch = "x86_64"))]
        Self {}
    }
}

impl Drop for DefaultFloats {
    fn drop(&mut self) {
        #[cfg(target_arch = "x86_64")]
        if self.before & !0x3f != MXCSR_DEFAULT {
            load(self.before);
        }
    }
}

#[cfg(target_arch = "x86_64")]
fn load(mxcsr: u32) {
    // SAFETY: a valid MXCSR value: the default, or one that this thread had.
    unsafe { core::arch::asm!("ldmxcsr [{}]", in(reg) &raw const mxcsr, options(nostack, readonly)) };
}
