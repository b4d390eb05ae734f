#include "base/shared_pages.h"

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <string>

namespace vernier {
namespace {

/// The last bytes of the file.
struct Note {
    uint64_t magic, tag, bytes;
};
constexpr uint64_t kMagic = 0x736761506E7256;  // "VrnPags", little-endian
constexpr int kSeals = F_SEAL_SHRINK | F_SEAL_GROW | F_SEAL_SEAL;

uint64_t fileSize(uint64_t bytes) {
    const auto page = static_cast<uint64_t>(sysconf(_SC_PAGESIZE));
    return (bytes + SharedPages::kSlack + sizeof(Note) + page - 1) / page * page;
}

Error systemError(const std::string& what) {
    return {ErrorCode::outOfDeviceMemory, what + ": " + std::strerror(errno)};
}

}  // namespace

Status SharedPages::map(uint64_t bytes, bool touch) {
    void* const data = mmap(nullptr, bytes, PROT_READ | PROT_WRITE, MAP_SHARED | (touch ? MAP_POPULATE : 0), fd_, 0);
    if (data == MAP_FAILED) return systemError("shared memory of " + std::to_string(bytes) + " bytes: mmap");
    data_ = static_cast<std::byte*>(data);
    mapped_ = bytes;
    return {};
}

Result<std::unique_ptr<SharedPages>> SharedPages::create(uint64_t tag, uint64_t bytes, bool touch) {
    if (bytes > static_cast<uint64_t>(PTRDIFF_MAX) / 2)
        return Error{ErrorCode::outOfDeviceMemory, "shared memory of " + std::to_string(bytes) + " bytes does not fit"};
    std::unique_ptr<SharedPages> pages(new SharedPages);
    pages->fd_ = memfd_create("vernier", MFD_CLOEXEC | MFD_ALLOW_SEALING);
    if (pages->fd_ < 0) return systemError("shared memory: memfd_create");
    const uint64_t whole = fileSize(bytes);
    if (ftruncate(pages->fd_, static_cast<off_t>(whole)) != 0 || fcntl(pages->fd_, F_ADD_SEALS, kSeals) != 0)
        return systemError("shared memory of " + std::to_string(bytes) + " bytes");
    if (Status status = pages->map(whole, touch); !status) return status.error();
    pages->size_ = bytes;
    const Note note{kMagic, tag, bytes};
    std::memcpy(pages->data_ + whole - sizeof note, &note, sizeof note);
    return pages;
}

Result<std::unique_ptr<SharedPages>> SharedPages::import(uint64_t tag, int fd) {
    const auto refuse = [](const char* why) { return invalidArgument(std::string("the file descriptor ") + why); };
    struct stat info {};
    if (fd < 0 || fstat(fd, &info) != 0) return refuse("is not open");
    const int seals = fcntl(fd, F_GET_SEALS);
    if (seals < 0 || (seals & kSeals) != kSeals || info.st_size < static_cast<off_t>(fileSize(0)))
        return refuse("does not come from an export of this driver");
    std::unique_ptr<SharedPages> pages(new SharedPages);
    pages->fd_ = fd;
    const Status mapped = pages->map(static_cast<uint64_t>(info.st_size), false);
    Note note{};
    if (mapped) std::memcpy(&note, pages->data_ + pages->mapped_ - sizeof note, sizeof note);
    const bool ours = note.magic == kMagic && note.bytes < pages->mapped_ && fileSize(note.bytes) == pages->mapped_;
    if (!mapped || !ours || note.tag != tag) {
        pages->fd_ = -1;  // stays the caller's
        if (!mapped) return mapped.error();
        return refuse(ours ? "is that of an object of another kind" : "does not come from an export of this driver");
    }
    pages->size_ = note.bytes;
    fcntl(fd, F_SETFD, FD_CLOEXEC);
    return pages;
}

SharedPages::~SharedPages() {
    if (data_ != nullptr) munmap(data_, mapped_);
    if (fd_ >= 0) close(fd_);
}

int SharedPages::exportFd() const {
    return fcntl(fd_, F_DUPFD_CLOEXEC, 0);
}

}  // namespace vernier
