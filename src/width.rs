//! Loops over numbers, compiled for each vector width of the architecture and chosen at run time.
//!
//! A loop is one function whatever the width: nothing is fused or reordered, so the numbers that come out are the same.
//! The unsafe code here is one thing: calling a function that was compiled for instructions which the machine was asked
//! about.

/// A vector width that this machine has.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Width(Instructions);

// A width exists only where its instructions were detected: `Width::available` alone makes any but the baseline.
/// What a function can be compiled for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Instructions {
    Baseline,
    #[cfg(target_arch = "x86_64")]
    Avx2,
    #[cfg(target_arch = "x86_64")]
    Avx512,
}

impl Width {
    /// What every machine of this architecture has.
    pub const BASELINE: Width = Width(Instructions::Baseline);

    /// The widths of this machine, narrowest first.
    pub fn available() -> impl Iterator<Item = Width> {
        let found = [
            Some(Width::BASELINE),
            #[cfg(target_arch = "x86_64")]
            is_x86_feature_detected!("avx2").then_some(Width(Instructions::Avx2)),
            #[cfg(target_arch = "x86_64")]
            has_avx512().then_some(Width(Instructions::Avx512)),
        ];
        found.into_iter().flatten()
    }

    /// The widest of this machine. The standard library remembers what it detected.
    #[inline]
    pub fn widest() -> Width {
        #[cfg(target_arch = "x86_64")]
        if has_avx512() {
            return Width(Instructions::Avx512);
        } else if is_x86_feature_detected!("avx2") {
            return Width(Instructions::Avx2);
        }
        Width::BASELINE
    }

    /// What it stands for.
    pub(crate) fn instructions(self) -> Instructions {
        self.0
    }

    /// The name of the instructions.
    pub fn name(self) -> &'static str {
        match self.0 {
            Instructions::Baseline => "baseline",
            #[cfg(target_arch = "x86_64")]
            Instructions::Avx2 => "AVX2",
            #[cfg(target_arch = "x86_64")]
            Instructions::Avx512 => "AVX-512",
        }
    }
}

#[cfg(target_arch = "x86_64")]
fn has_avx512() -> bool {
    is_x86_feature_detected!("avx512f")
        && is_x86_feature_detected!("avx512dq")
        && is_x86_feature_detected!("avx512bw")
        && is_x86_feature_detected!("avx512vl")
}

/// A loop over numbers that becomes vector code: its `run`, and all that it calls, must be `#[inline(always)]`.
pub trait Wide {
    /// What it works out.
    type Output;
    /// Runs it.
    fn run(self) -> Self::Output;
}

/// Makes of a function whose body is to become vector code one for the widest instructions of the machine, and one for a
/// given width. The arguments stay arguments: what they refer to is then known to be apart.
macro_rules! at_every_width {
    ($(#[$doc:meta])* $name:ident, $at:ident = $loop:ident($($argument:ident: $type:ty),+)) => {
        $(#[$doc])*
        pub fn $name($($argument: $type),+) {
            $at($crate::width::Width::widest(), $($argument),+)
        }

        #[doc(hidden)]
        #[cfg_attr(target_arch = "x86_64", allow(unsafe_code))]
        pub fn $at(width: $crate::width::Width, $($argument: $type),+) {
            use $crate::width::Instructions;
            #[cfg(target_arch = "x86_64")]
            #[target_feature(enable = "avx2")]
            fn avx2($($argument: $type),+) {
                $loop($($argument),+)
            }
            #[cfg(target_arch = "x86_64")]
            #[target_feature(enable = "avx512f,avx512dq,avx512bw,avx512vl")]
            fn avx512($($argument: $type),+) {
                $loop($($argument),+)
            }
            match width.instructions() {
                Instructions::Baseline => $loop($($argument),+),
                // SAFETY: a `Width` of these instructions exists only where they were detected.
                #[cfg(target_arch = "x86_64")]
                Instructions::Avx2 => unsafe { avx2($($argument),+) },
                // SAFETY: as above.
                #[cfg(target_arch = "x86_64")]
                Instructions::Avx512 => unsafe { avx512($($argument),+) },
            }
        }
    };
}
pub(crate) use at_every_width;

/// Runs a loop, compiled for the widest instructions of the machine.
#[cfg_attr(target_arch = "x86_64", allow(unsafe_code))]
#[inline]
pub fn at_widest<W: Wide>(wide: W) -> W::Output {
    #[cfg(target_arch = "x86_64")]
    #[target_feature(enable = "avx2")]
    fn avx2<W: Wide>(wide: W) -> W::Output {
        wide.run()
    }
    #[cfg(target_arch = "x86_64")]
    #[target_feature(enable = "avx512f,avx512dq,avx512bw,avx512vl")]
    fn avx512<W: Wide>(wide: W) -> W::Output {
        wide.run()
    }
    match Width::widest().0 {
        Instructions::Baseline => wide.run(),
        // SAFETY: a `Width` of these instructions exists only where they were detected.
        #[cfg(target_arch = "x86_64")]
        Instructions::Avx2 => unsafe { avx2(wide) },
        // SAFETY: as above.
        #[cfg(target_arch = "x86_64")]
        Instructions::Avx512 => unsafe { avx512(wide) },
    }
}
