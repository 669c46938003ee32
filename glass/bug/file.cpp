// Bug files: the header and the blobs around glass/bug/archive.h.
#include "glass/bug/file.h"

#include "glass/bug/archive.h"
#include "glass/bug/pack.h"

namespace vitrine::glass::bug {
namespace {

/// Of version 1: whoever changes what a member means, or takes one away, counts on.
constexpr std::string_view kMagic = "vitrine-bug 2\n";
constexpr std::string_view kFamily = "vitrine-bug ";
constexpr std::size_t kLengthBytes = 8;

std::string little_endian(std::uint64_t value) {
  std::string bytes(kLengthBytes, 0);
  for (std::size_t i = 0; i < kLengthBytes; ++i) bytes[i] = static_cast<char>(value >> (8 * i) & 0xff);
  return bytes;
}

std::uint64_t little_endian(std::string_view bytes) {
  std::uint64_t value = 0;
  for (std::size_t i = kLengthBytes; i-- > 0;) value = value << 8 | static_cast<unsigned char>(bytes[i]);
  return value;
}

/// Visitors take members that they could change.
Json header_of(const Bug& bug, BlobWriter& blobs) {
  Writer writer(blobs);
  return writer.json_of(const_cast<Bug&>(bug));
}

std::string text_of(const Json& json, int indentation) {
  return json.dump(indentation, ' ', false, Json::error_handler_t::replace);
}

base::Result<Bug> read_parts(std::string_view bytes) {
  if (!bytes.starts_with(kFamily)) return base::Error{"it is no bug file"};
  if (!bytes.starts_with(kMagic)) return base::Error{"another version of Vitrine wrote it"};
  bytes.remove_prefix(kMagic.size());
  if (bytes.size() < kLengthBytes) return base::Error{"it ends too early"};
  const std::uint64_t length = little_endian(bytes);
  bytes.remove_prefix(kLengthBytes);
  if (length > bytes.size()) return base::Error{"it ends too early"};
  BlobReader blobs(bytes.substr(length));
  Bug bug;
  const Json header = Json::parse(bytes.substr(0, length));
  Reader reader(header, blobs);
  fields(reader, bug);
  if (std::string fault = fault_of(bug); !fault.empty()) return base::Error{"it names " + fault};
  return bug;
}

}  // namespace

std::string to_file(const Bug& bug) {
  BlobWriter blobs;
  const std::string header = text_of(header_of(bug, blobs), -1);
  std::string bytes(kMagic);
  bytes.append(little_endian(header.size())).append(header).append(blobs.bytes());
  return pack(bytes);
}

base::Result<Bug> from_file(std::string_view contents) {
  base::Result<std::string> bytes = unpack(contents);
  if (!bytes) return bytes.error();
  try {
    return read_parts(bytes.value());
  } catch (const Json::exception& error) {
    return base::Error{std::string("its header is broken: ") + error.what()};
  } catch (const std::out_of_range& error) {
    return base::Error{std::string("it names ") + error.what()};
  }
}

std::string describe(const Bug& bug) {
  BlobWriter blobs;
  return text_of(header_of(bug, blobs), 2) + "\n";
}

}  // namespace vitrine::glass::bug
