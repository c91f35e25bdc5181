// Carries, in a kernel without other loops: a group of invocations without carries leaves this
// one at once.
fn add_carries(word: u32, carries: u32) {
    for (var left = carries; left != 0u; left &= left - 1u) {
        atomicAdd(&film[word + firstTrailingBit(left)], 1u);
    }
}
