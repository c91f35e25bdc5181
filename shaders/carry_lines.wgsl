// Carries, in a kernel whose loops a driver may have cut short for another sample of the group:
// after that, it would go through a loop once, and lose the carries beyond the first.
fn add_carries(word: u32, carries: u32) {
    add_carry(word + 2u, carries >> 2u);
    add_carry(word + 5u, carries >> 5u);
    add_carry(word + 8u, carries >> 8u);
    add_carry(word + 12u, carries >> 12u);
}

fn add_carry(word: u32, carry: u32) {
    if (carry & 1u) != 0u {
        atomicAdd(&film[word], 1u);
    }
}
