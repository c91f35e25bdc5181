//! Settings for the graphics drivers, which read them from the environment alone.

use std::ffi::OsString;
use std::num::NonZeroUsize;
use std::path::Path;

/// Prepares the environment; to be called before anything else starts.
///
/// `threads` limits software Vulkan. Mesa's device-select layer is told to stay out: it
/// would look for a display and complain on stderr that there is none. A folder is where Mesa and
/// NVIDIA then cache kernels: an empty one makes them compile afresh. Their caches are not switched
/// off, because without one lavapipe compiles some kernels again for each dispatch.
#[expect(unsafe_code, reason = "the only way to reach a driver that is loaded later")]
pub(super) fn prepare(threads: Option<NonZeroUsize>, cache: Option<&Path>) {
    let mut settings = vec![("NODEVICE_SELECT", OsString::from("1"))];
    settings.extend(threads.map(|n| ("LP_NUM_THREADS", n.to_string().into())));
    if let Some(folder) = cache {
        settings.push(("MESA_SHADER_CACHE_DIR", folder.into()));
        settings.push(("__GL_SHADER_DISK_CACHE_PATH", folder.into()));
    }
    for (name, value) in settings {
        // SAFETY: `set_var` is unsound only while another thread reads the environment;
        // this runs first in `main`, before any other thread exists.
        unsafe { std::env::set_var(name, value) };
    }
}
