// Depth tests: which of two fragments at a pixel is seen, and the depth that stays.
// compare by its code: bit 0 passes less, bit 1 equal, bit 2 greater. Depths are clamped to [0, 1] before they are compared.

struct Tested {
    // 1 where the fragment that was there stays, 2 where the new one is seen.
    seen: f32,
    depth: f32,
}

fn depth_passes(compare: u32, drawn: f32, stored: f32) -> bool {
    var outcome = 1u;
    if drawn == stored {
        outcome = 2u;
    }
    if drawn > stored {
        outcome = 4u;
    }
    return (compare & outcome) != 0u;
}

fn depth_test(compare: u32, write: u32, new_depth: f32, old_depth: f32) -> Tested {
    let drawn = saturate(new_depth);
    let stored = saturate(old_depth);
    if !depth_passes(compare, drawn, stored) {
        return Tested(1.0, stored);
    }
    return Tested(2.0, select(stored, drawn, write == 1u));
}

// Depth as it is stored, and the distance read back from it.

fn depth_stored(near: f32, far: f32, z: f32) -> f32 {
    return far * (z - near) / (z * (far - near));
}

fn depth_stored_reversed(near: f32, far: f32, z: f32) -> f32 {
    return near * (far - z) / (z * (far - near));
}

fn depth_recovered(near: f32, far: f32, z: f32) -> f32 {
    return near * far / (far - depth_stored(near, far, z) * (far - near));
}

// stable form of: depth_recovered
fn depth_recovered_reversed(near: f32, far: f32, z: f32) -> f32 {
    return near * far / (near + depth_stored_reversed(near, far, z) * (far - near));
}
