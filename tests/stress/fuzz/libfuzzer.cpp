// The entry of libFuzzer; SSS_FUZZ_TARGET names the reader.
#include "fuzz/input_file.h"
#include "fuzz/targets.h"

#include <cstdint>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    static const sss::stress::FuzzTarget* const target =
        sss::stress::findFuzzTarget(SSS_FUZZ_TARGET);
    if (!target) sss::stress::fail("no such target");
    target->read(std::as_bytes(std::span(data, size)));
    return 0;
}
