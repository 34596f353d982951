// Debian's library has support for shared memory, which changes the layout of what is declared here.
#define DDS_HAS_SHM 1

#include "dds/raw_type.h"

#include <dds/ddsi/ddsi_serdata.h>
#include <dds/ddsi/ddsi_sertype.h>
#include <dds/ddsi/q_radmin.h>

#include <cstdio>
#include <cstring>
#include <mutex>
#include <vector>

namespace rondo::dds {
namespace {

struct RawData : ddsi_serdata {
  // Completes the last group of four, which the library sends as a whole.
  void Pad() { bytes.resize((bytes.size() + 3) / 4 * 4); }
  std::string bytes;
};

// Keeps samples, with their memory, for the next ones.
class Pool {
 public:
  // Lives as long as the process: the library may hold samples to its end.
  static Pool& Get() {
    static auto* pool = new Pool;
    return *pool;
  }
  RawData* New(const ddsi_sertype* type, ddsi_serdata_kind kind) {
    RawData* data = Pop();
    if (data == nullptr) data = new RawData{};
    data->bytes.clear();
    ddsi_serdata_init(data, type, kind);
    return data;
  }
  void Give(RawData* data) {
    if (data->bytes.capacity() <= kMostBytes) {
      const std::lock_guard lock(mutex_);
      if (kept_.size() < kMostKept) return kept_.push_back(data);
    }
    delete data;
  }

 private:
  static constexpr size_t kMostKept = 256, kMostBytes = 4096;
  Pool() { kept_.reserve(kMostKept); }
  RawData* Pop() {
    const std::lock_guard lock(mutex_);
    if (kept_.empty()) return nullptr;
    RawData* data = kept_.back();
    kept_.pop_back();
    return data;
  }
  std::mutex mutex_;
  std::vector<RawData*> kept_;
};

RawData* New(const ddsi_sertype* type, ddsi_serdata_kind kind) { return Pool::Get().New(type, kind); }

const RawData& Raw(const ddsi_serdata* data) { return *static_cast<const RawData*>(data); }

// Without keys, all samples are of one instance.
bool SameKey(const ddsi_serdata*, const ddsi_serdata*) { return true; }
uint32_t Size(const ddsi_serdata* data) { return static_cast<uint32_t>(Raw(data).bytes.size()); }

ddsi_serdata* FromFragments(const ddsi_sertype* type, ddsi_serdata_kind kind, const nn_rdata* fragment,
                            size_t size) {
  auto* data = New(type, kind);
  data->bytes.resize(size);
  uint32_t done = 0;  // fragments may overlap
  for (; fragment != nullptr; fragment = fragment->nextfrag) {
    if (fragment->maxp1 <= done) continue;
    const auto* payload = NN_RMSG_PAYLOADOFF(fragment->rmsg, NN_RDATA_PAYLOAD_OFF(fragment));
    std::memcpy(data->bytes.data() + done, payload + (done - fragment->min), fragment->maxp1 - done);
    done = fragment->maxp1;
  }
  data->Pad();
  return data;
}

ddsi_serdata* FromPieces(const ddsi_sertype* type, ddsi_serdata_kind kind, ddsrt_msg_iovlen_t count,
                         const ddsrt_iovec_t* pieces, size_t size) {
  auto* data = New(type, kind);
  for (ddsrt_msg_iovlen_t i = 0; i < count; ++i)
    data->bytes.append(static_cast<const char*>(pieces[i].iov_base), pieces[i].iov_len);
  data->bytes.resize(size);
  data->Pad();
  return data;
}

ddsi_serdata* FromKeyHash(const ddsi_sertype* type, const ddsi_keyhash*) { return New(type, SDK_KEY); }

ddsi_serdata* FromSample(const ddsi_sertype* type, ddsi_serdata_kind kind, const void* sample) {
  auto* data = New(type, kind);
  if (kind == SDK_DATA) data->bytes = *static_cast<const std::string_view*>(sample);
  data->Pad();
  return data;
}

void Copy(const ddsi_serdata* data, size_t offset, size_t size, void* out) {
  std::memcpy(out, Raw(data).bytes.data() + offset, size);
}

ddsi_serdata* Borrow(const ddsi_serdata* data, size_t offset, size_t size, ddsrt_iovec_t* out) {
  out->iov_base = const_cast<char*>(Raw(data).bytes.data() + offset);  // NOLINT: the library only reads it
  out->iov_len = size;
  return ddsi_serdata_ref(data);
}
void GiveBack(ddsi_serdata* data, const ddsrt_iovec_t*) { ddsi_serdata_unref(data); }

bool ToSample(const ddsi_serdata* data, void* sample, void**, void*) {
  *static_cast<std::string*>(sample) = Raw(data).bytes;
  return true;
}
ddsi_serdata* ToUntyped(const ddsi_serdata* data) {
  auto* untyped = New(data->type, SDK_KEY);
  untyped->type = nullptr;
  return untyped;
}
bool UntypedToSample(const ddsi_sertype*, const ddsi_serdata*, void*, void**, void*) { return true; }
void Free(ddsi_serdata* data) { Pool::Get().Give(static_cast<RawData*>(data)); }
size_t Show(const ddsi_sertype*, const ddsi_serdata* data, char* out, size_t size) {
  return static_cast<size_t>(std::snprintf(out, size, "%zu bytes", Raw(data).bytes.size()));
}
void KeyHash(const ddsi_serdata*, ddsi_keyhash* out, bool) { std::memset(out, 0, sizeof(*out)); }

const ddsi_serdata_ops kDataOps = {SameKey, Size,   FromFragments, FromPieces, FromKeyHash, FromSample,
                                   Copy,    Borrow, GiveBack,      ToSample,   ToUntyped,   UntypedToSample,
                                   Free,    Show,   KeyHash,       Size,       nullptr};

void FreeType(ddsi_sertype* type) {
  ddsi_sertype_fini(type);
  delete type;
}
void NoSamples(const ddsi_sertype*, void*, size_t) {}
void NoMoreSamples(void**, const ddsi_sertype*, void*, size_t, size_t) {}
void NoneToFree(const ddsi_sertype*, void**, size_t, dds_free_op_t) {}
bool SameType(const ddsi_sertype*, const ddsi_sertype*) { return true; }  // their names are
uint32_t HashOfType(const ddsi_sertype*) { return 0; }

const ddsi_sertype_ops kTypeOps = {ddsi_sertype_v0, nullptr,  FreeType,   NoSamples, NoMoreSamples,
                                   NoneToFree,      SameType, HashOfType, nullptr,   nullptr,
                                   nullptr,         nullptr,  nullptr,    nullptr};

}  // namespace

dds_entity_t CreateRawTopic(dds_entity_t participant, const std::string& topic, const std::string& type,
                            const dds_qos_t* qos) {
  auto* raw = new ddsi_sertype{};
  ddsi_sertype_init_flags(raw, type.c_str(), &kTypeOps, &kDataOps, DDSI_SERTYPE_FLAG_TOPICKIND_NO_KEY);
  raw->allowed_data_representation = DDS_DATA_REPRESENTATION_FLAG_XCDR1;
  const dds_entity_t entity =
      dds_create_topic_sertype(participant, topic.c_str(), &raw, qos, nullptr, nullptr);
  if (entity < 0) ddsi_sertype_unref(raw);
  return entity;
}

bool TakeRaw(dds_entity_t reader, std::string& bytes, dds_sample_info_t& info) {
  ddsi_serdata* data = nullptr;
  if (dds_takecdr(reader, &data, 1, &info, DDS_ANY_STATE) <= 0) return false;
  if (info.valid_data) bytes = Raw(data).bytes;
  ddsi_serdata_unref(data);
  return true;
}

}  // namespace rondo::dds
