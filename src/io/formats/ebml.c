/* Elements of EBML (RFC 8794). */
#include "io/formats/matroska.h"

int32_t ebml_number(const uint8_t *data, size_t size, uint64_t *out, bool *out_is_unknown)
{
    int32_t length = 1;
    while (length <= 8 && size > 0 && (data[0] & (0x100u >> length)) == 0) {
        length++;
    }
    if (length > 8 || (size_t)length > size) {
        return 0;
    }
    uint64_t value = data[0] & ((0x100u >> length) - 1);
    for (int32_t i = 1; i < length; i++) {
        value = value << 8 | data[i];
    }
    *out = value;
    *out_is_unknown = value == (UINT64_C(1) << (7 * length)) - 1;
    return length;
}

bool ebml_read(const uint8_t *data, size_t size, ebml_element *out)
{
    uint64_t value = 0;
    bool is_unknown = false;
    const int32_t id_length = ebml_number(data, size, &value, &is_unknown);
    if (id_length < 1 || id_length > 4) {
        return false;
    }
    /* An id keeps its marker. */
    out->id = (uint32_t)ebml_unsigned(data, (size_t)id_length);
    const int32_t length =
        ebml_number(data + id_length, size - (size_t)id_length, &value, &is_unknown);
    out->header_size = id_length + length;
    out->size = is_unknown ? -1 : (int64_t)value;
    return length > 0;
}

uint64_t ebml_unsigned(const uint8_t *data, size_t size)
{
    uint64_t value = 0;
    for (size_t i = 0; i < size && i < 8; i++) {
        value = value << 8 | data[i];
    }
    return value;
}
