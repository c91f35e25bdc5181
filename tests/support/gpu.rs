//! The device that the tests need: no Vulkan device is a failure, never a skip.

use candor::gpu::{Adapter, Gpu, adapters};
use std::sync::OnceLock;

/// The first software adapter, found and named once. Its results do not depend on the
/// machine, and it is the one adapter that every machine can have.
fn adapter() -> &'static Adapter {
    static ADAPTER: OnceLock<Adapter> = OnceLock::new();
    ADAPTER.get_or_init(|| {
        let found = adapters();
        let Some(adapter) = found.iter().find(|adapter| adapter.is_software()) else {
            let names: Vec<&str> = found.iter().map(Adapter::name).collect();
            panic!(
                "these tests need software Vulkan (Mesa's lavapipe) and found {names:?}; run them \
                 with the test command in README.md, which says how to get it"
            );
        };
        println!("tested on {}, {}", adapter.name(), adapter.driver());
        adapter.clone()
    })
}

/// Opens the device.
///
/// # Panics
/// If there is none.
pub fn open() -> Gpu {
    Gpu::open(adapter()).expect("the software adapter opens")
}
