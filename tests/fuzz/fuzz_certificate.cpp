// Any text given to the readers of what the cache keeps of sets and meshes either makes a
// certificate that is written so that it reads back the same, or throws Error. The first byte
// selects which.

#include "../../libcertify/src/enclosure_record.h"
#include "../../libcertify/src/set_record.h"
#include "fuzz.h"

namespace {

template <class Read, class Write>
void look_at(const std::string& text, const Read& read, const Write& write) {
  const std::string once = write(read(text));
  if (write(read(once)) != once) kaboum::fuzz::broken("another certificate", once);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace kaboum::certify;
  if (size == 0) return 0;
  const std::string text = kaboum::fuzz::text_of(data, size);
  kaboum::fuzz::survive([&] {
    if (data[0] % 2 == 0)
      look_at(text, read_record, write_record);
    else
      look_at(text, read_enclosure, write_enclosure);
  });
  return 0;
}
