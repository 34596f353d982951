"""MCAP files for tests."""


def unsealed(file):
    """An MCAP file without checksums: who changes it means to."""
    out, at = bytearray(file), 8
    while at + 9 <= len(file) - 8:
        kind, size = file[at], int.from_bytes(file[at + 1:at + 9], "little")
        crc = {0x06: at + 9 + 24, 0x0F: at + 9, 0x02: at + 9 + 16}.get(kind)
        if crc is not None:
            out[crc:crc + 4] = bytes(4)
        at += 9 + size
    return bytes(out)
