// Parts of a batch.

#include <kaboum/base/error.h>
#include <kaboum/batch/batch.h>
#include <kaboum/io/mesh_io.h>

#include <charconv>

namespace kaboum::batch {
namespace {

/// All of the text as a number; 0: it is none.
std::size_t number_of(std::string_view text) {
  std::size_t value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  return error == std::errc() && end == text.data() + text.size() ? value : 0;
}

}  // namespace

bool Shard::has(const std::string& name) const {
  constexpr std::size_t kDigits = 15;  // 60 bits, far more than there are parts
  const std::string hash = io::sha256(name).substr(0, kDigits);
  return std::stoull(hash, nullptr, 16) % count == number - 1;
}

Shard parse_shard(const std::string& text) {
  const std::string_view all = text;
  const std::size_t slash = all.find('/');
  Shard shard{0, 0};
  if (slash != std::string_view::npos)
    shard = {number_of(all.substr(0, slash)), number_of(all.substr(slash + 1))};
  if (shard.number == 0 || shard.number > shard.count)
    throw Error(ErrorCode::InvalidArgument,
                "«shard»: give a part and the number of parts, from 1/8 to 8/8, not " + text);
  return shard;
}

}  // namespace kaboum::batch
