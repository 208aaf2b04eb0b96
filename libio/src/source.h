#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace kaboum::io {

/// A file in memory and how to speak of places in it. Internal to kaboum_io.
struct Source {
  std::string_view bytes;
  std::string_view name;            ///< for messages only
  std::filesystem::path directory;  ///< where files that this one refers to are looked for
  bool text = true;                 ///< places are line numbers, else byte offsets

  [[nodiscard]] const char* begin() const { return bytes.data(); }
  [[nodiscard]] const char* end() const { return bytes.data() + bytes.size(); }
};

/// "line 12" or "byte 345". Lines are counted here, on demand, so that parsing need not.
std::string place(const Source& source, const char* where);

/// `text` in quotes, shortened, control characters replaced: fit for a message.
std::string in_quotes(std::string_view text, std::size_t longest = 40);

/// "1 thing" or "2 things".
std::string counted(std::size_t count, std::string_view singular, std::string_view plural);

/// Throws Error{InvalidInput} "<name>: <place>: <what>".
[[noreturn]] void fail(const Source& source, const char* where, const std::string& what);

/// Throws Error{InvalidInput} "<name>: <what>", about the file as a whole.
[[noreturn]] void fail(const Source& source, const std::string& what);

}  // namespace kaboum::io
