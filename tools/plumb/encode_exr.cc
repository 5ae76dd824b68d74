#include <algorithm>
#include <cstring>

#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfIO.h>
#include <OpenEXR/ImfOutputFile.h>

#include "encode.h"

namespace plumb::tool {
namespace {

/// A file in memory. OutputFile's destructor writes its last bytes and swallows every error; here
/// there is none, and the file on disk is written where errors are seen.
class MemoryStream : public Imf::OStream {
 public:
  MemoryStream() : Imf::OStream("memory") {}

  void write(const char* bytes, int count) override {
    const std::size_t end = position_ + static_cast<std::size_t>(count);
    bytes_.resize(std::max(bytes_.size(), end));
    std::memcpy(bytes_.data() + position_, bytes, static_cast<std::size_t>(count));
    position_ = end;
  }
  std::uint64_t tellp() override { return position_; }
  void seekp(std::uint64_t position) override { position_ = position; }

  std::vector<std::byte> take() { return std::move(bytes_); }

 private:
  std::vector<std::byte> bytes_;
  std::size_t position_ = 0;
};

// OpenEXR asks for a pointer that is not const and only reads through it.
template <typename T>
Imf::Slice slice(Imf::PixelType type, const std::vector<T>& channel, int width) {
  static_assert(sizeof(T) == 4);
  char* data = reinterpret_cast<char*>(const_cast<T*>(channel.data()));
  return Imf::Slice(type, data, sizeof(T), sizeof(T) * static_cast<std::size_t>(width));
}

}  // namespace

std::vector<std::byte> encode_exr(const Frame& frame) {
  Imf::Header header(frame.width, frame.height);
  header.compression() = Imf::ZIP_COMPRESSION;
  header.channels().insert("Z", Imf::Channel(Imf::FLOAT));
  header.channels().insert("id", Imf::Channel(Imf::UINT));
  Imf::FrameBuffer buffer;
  buffer.insert("Z", slice(Imf::FLOAT, frame.depth, frame.width));
  buffer.insert("id", slice(Imf::UINT, frame.id, frame.width));

  MemoryStream stream;
  {
    Imf::OutputFile file(stream, header);
    file.setFrameBuffer(buffer);
    file.writePixels(frame.height);
  }
  return stream.take();
}

}  // namespace plumb::tool
