#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Decodes an Ouster capture without any of the product's code, to make the golden values of the tests.

usage: replay_golden.py CAPTURE.pcap METADATA.json RANGE_BITS RANGE_SCALE CHANNEL_BYTES legacy|standard|fusa [dual]
Of dual returns all first ones come before all second ones. Prints, per frame: id, columns, points, first and last column time, sums of x, y, z (m), and three points.
"""
import json
import math
import struct
import sys


def datagrams(path):
    data = open(path, "rb").read()
    at = 24
    parts = {}
    while at + 16 <= len(data):
        captured = struct.unpack_from("<I", data, at + 8)[0]
        packet = data[at + 16 + 14 : at + 16 + captured]
        at += 16 + captured
        if packet[0] >> 4 != 4:
            continue
        header = (packet[0] & 15) * 4
        total, ident, flags = struct.unpack_from(">HHH", packet, 2)
        payload, offset, more = packet[header:total], (flags & 0x1FFF) * 8, flags & 0x2000
        key = (packet[12:20], ident)
        held = parts.setdefault(key, {})
        held[offset] = payload
        if not more:
            held["end"] = offset + len(payload)
        pieces = sorted((k, v) for k, v in held.items() if k != "end")
        if "end" in held and sum(len(v) for _, v in pieces) == held["end"]:
            del parts[key]
            yield b"".join(v for _, v in pieces)[8:]


def main():
    pcap, metadata, bits, scale, channel = sys.argv[1], json.load(open(sys.argv[2])), *map(int, sys.argv[3:6])
    framing, returns = sys.argv[6], 2 if sys.argv[7:] == ["dual"] else 1
    beams = metadata.get("beam_intrinsics", metadata)
    fmt = metadata.get("lidar_data_format") or metadata.get("data_format")
    lidar = metadata.get("lidar_intrinsics", metadata)
    width, rows = fmt["columns_per_frame"], fmt["pixels_per_column"]
    b2l = beams.get("beam_to_lidar_transform")
    bx, bz = (b2l[3], b2l[11]) if b2l else (beams["lidar_origin_to_beam_origin_mm"], 0.0)
    n = math.hypot(bx, bz)
    l2s = lidar["lidar_to_sensor_transform"]
    head, column_head, foot = (0, 16, 4) if framing == "legacy" else (32, 12, 0)
    column_bytes = column_head + rows * channel + foot
    size = head + 16 * column_bytes + (0 if framing == "legacy" else 32)
    frames = {}
    for d in datagrams(pcap):
        if len(d) != size:
            continue
        for c in range(16):
            o = head + c * column_bytes
            time, column = struct.unpack_from("<QH", d, o)
            if framing == "legacy":
                frame = struct.unpack_from("<H", d, o + 10)[0]
                valid = struct.unpack_from("<I", d, o + column_bytes - 4)[0] & 1
            else:
                frame = struct.unpack_from("<I", d, 4)[0] if framing == "fusa" else struct.unpack_from("<H", d, 2)[0]
                valid = struct.unpack_from("<H", d, o + 10)[0] & 1
            if not valid:
                continue
            points = frames.setdefault(frame, {})
            row_points = [[], []]
            for r in range(rows * returns):
                r, second = r % rows, r // rows
                raw = struct.unpack_from("<I", d, o + column_head + r * channel + 4 * second)[0]
                rng = (raw & ((1 << bits) - 1)) * scale
                if rng == 0:
                    continue
                enc = 2 * math.pi - column * 2 * math.pi / width
                azi = -math.radians(beams["beam_azimuth_angles"][r])
                alt = math.radians(beams["beam_altitude_angles"][r])
                p = [
                    (rng - n) * math.cos(enc + azi) * math.cos(alt) + bx * math.cos(enc),
                    (rng - n) * math.sin(enc + azi) * math.cos(alt) + bx * math.sin(enc),
                    (rng - n) * math.sin(alt) + bz,
                ]
                row_points[second].append([(sum(l2s[4 * i + j] * p[j] for j in range(3)) + l2s[4 * i + 3]) / 1000 for i in range(3)])
            points[column] = (time, row_points)
    for frame, columns in frames.items():
        times = [t for t, _ in columns.values()]
        flat = [p for second in (0, 1) for c in sorted(columns) for p in columns[c][1][second]]
        sums = [sum(p[i] for p in flat) for i in range(3)]
        print(frame, len(columns), len(flat), min(times), max(times), *(f"{s:.6f}" for s in sums))
        for i in (0, len(flat) // 2, len(flat) - 1):
            print("  ", i, *(f"{v:.6f}" for v in flat[i]))


main()
