//! Settings for the graphics drivers, which read them from the environment alone.

use std::num::NonZeroUsize;

/// Prepares the environment; to be called before anything else starts.
///
/// `threads` limits software Vulkan. Mesa's device-select layer is told to stay out: it
/// would look for a display and complain on stderr that there is none. Where kernels are to be
/// compiled `afresh`, the caches that Mesa and NVIDIA keep on the disk are off.
#[expect(unsafe_code, reason = "the only way to reach a driver that is loaded later")]
pub(super) fn prepare(threads: Option<NonZeroUsize>, afresh: bool) {
    let mut settings = vec![("NODEVICE_SELECT", "1".to_owned())];
    settings.extend(threads.map(|n| ("LP_NUM_THREADS", n.to_string())));
    if afresh {
        settings.push(("MESA_SHADER_CACHE_DISABLE", "true".to_owned()));
        settings.push(("__GL_SHADER_DISK_CACHE", "0".to_owned()));
    }
    for (name, value) in settings {
        // SAFETY: `set_var` is unsound only while another thread reads the environment;
        // this runs first in `main`, before any other thread exists.
        unsafe { std::env::set_var(name, value) };
    }
}
