"""A friend, and strangers, of `relief run --publish ws:PORT`: publish_client.py PORT [slow]."""
import asyncio
import base64
import json
import os
import socket
import sys

import websockets

PORT = int(sys.argv[1])
PLACE = f"ws://127.0.0.1:{PORT}"


def handshake(extra=""):
    key = base64.b64encode(os.urandom(16)).decode()
    return (
        f"GET / HTTP/1.1\r\nHost: 127.0.0.1:{PORT}\r\nUpgrade: websocket\r\nConnection: Upgrade\r\n"
        f"Sec-WebSocket-Key: {key}\r\nSec-WebSocket-Version: 13\r\n{extra}\r\n"
    ).encode()


def connect(size=None):
    s = socket.socket()
    if size:
        s.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, size)
    s.settimeout(60)
    s.connect(("127.0.0.1", PORT))
    return s


def slow():
    """Connects and never reads; ends when the run does, which closes the port."""
    s = connect(2048)
    s.sendall(handshake())
    while True:
        try:
            socket.create_connection(("127.0.0.1", PORT), 1).close()
        except ConnectionRefusedError:
            return
        except OSError:
            pass
        asyncio.run(asyncio.sleep(0.2))


def refused_origin():
    s = connect()
    s.sendall(handshake("Origin: http://evil.example\r\n"))
    answer = s.recv(100)
    assert b"101" not in answer, answer
    s.close()


def hostile():
    """Bytes that no WebSocket sends, before and after the upgrade; the run must go on."""
    for first in (b"\x00" * 5000, b"GET / HTTP/1.1\r\n\r\n", b"GET /" + b"a" * 9000, b""):
        s = connect()
        try:
            s.sendall(first)
            s.close()
        except OSError:
            pass
    for frame in (b"\x81\xff\xff\xff\xff\xff\xff\xff\xff\xff", b"\xff" * 64, b"\x81\xfe\x10\x00half"):
        s = connect()
        s.sendall(handshake())
        assert b"101" in s.recv(100)
        try:
            s.sendall(frame)
            s.close()
        except OSError:
            pass


async def wait_for(relief, is_it):
    for _ in range(3000):
        message = json.loads(await asyncio.wait_for(relief.recv(), 60))
        if is_it(message):
            return message
    raise AssertionError("it never came")


async def ask(relief, command):
    await relief.send(command if isinstance(command, (str, bytes)) else json.dumps(command))
    return await wait_for(relief, lambda m: m["type"] in ("done", "error"))


async def friend():
    async with websockets.connect(PLACE, max_size=None) as relief:
        hello = await wait_for(relief, lambda m: m["type"] == "hello")
        assert hello["version"] == 1 and hello["width"] == 512, hello
        ball = {"type": "spawn", "shape": "sphere", "radius": 0.1, "position": [0.3, 0, 1.5], "name": "mine"}
        assert (await ask(relief, ball))["type"] == "done"
        frame = await wait_for(relief, lambda m: any(b["name"] == "mine" for b in m["bodies"]))
        assert abs(frame["gravity"][1] - 9.81) < 1e-3, frame
        touch = await wait_for(relief, lambda m: any(c["body"] == "mine" for c in m["contacts"]))
        contact = next(c for c in touch["contacts"] if c["body"] == "mine")
        assert contact["state"] == "begin" and contact["impulse"] > 0, contact
        assert len(contact["position"]) == 3 and contact["normal"][1] < 0, contact
        await wait_for(relief, lambda m: m.get("regions"))
        assert (await ask(relief, {"type": "gravity", "value": [0, 1.6, 0]}))["type"] == "done"
        await wait_for(relief, lambda m: m.get("gravity", [0, 0])[1] == 1.6)
        assert (await ask(relief, {"type": "scene", "name": "stack"}))["type"] == "done"
        await wait_for(relief, lambda m: any(b["name"] == "cube_1" for b in m.get("bodies", [])))
        for wrong in (
            "half {", "[" * 4000, '{"type":"spawn","position":[NaN,0,0]}', '{"type":"scene","name":"../../etc/passwd"}',
            '{"type":"scene","name":"known"}', '{"type":"spawn","mass":-1}', '{"type":"remove","name":"nobody"}',
        ):  # fmt: skip
            answer = await ask(relief, wrong)
            assert answer["type"] == "error" and answer["text"], (wrong, answer)
        assert (await ask(relief, {"type": "clear"}))["type"] == "done"
        await wait_for(relief, lambda m: m.get("bodies") == [])


async def recording():
    """On and off, as often as one likes: the answer comes at once."""
    async with websockets.connect(PLACE, max_size=None) as relief:
        answer = await ask(relief, {"type": "record", "on": True})
        if answer["type"] == "done":
            await wait_for(relief, lambda m: m["type"] == "frame")
            assert (await ask(relief, {"type": "record", "on": False}))["type"] == "done"
            assert any(name.endswith(".mcap") for name in os.listdir(".")), os.listdir(".")


async def flood():
    """Thousands of commands at once; others are served meanwhile."""
    async with websockets.connect(PLACE, max_size=None) as stranger:
        for _ in range(3000):
            await stranger.send('{"type":"spawn","position":[0,0,99]}')
        async with websockets.connect(PLACE, max_size=None) as relief:
            assert (await ask(relief, {"type": "remove", "name": "nobody"}))["type"] == "error"


async def crowd():
    """Sixteen at most; the next one is turned away, and there is room again afterwards."""
    all = []
    try:
        while len(all) < 40:
            all.append(await websockets.connect(PLACE, max_size=None))
    except (websockets.WebSocketException, OSError):
        pass
    assert 8 <= len(all) <= 16, len(all)
    for one in all:
        await one.close()


async def too_long():
    async with websockets.connect(PLACE, max_size=None) as relief:
        await relief.send(" " * 100000)
        try:
            for _ in range(3000):
                await asyncio.wait_for(relief.recv(), 60)
            raise AssertionError("100 kB were taken")
        except websockets.ConnectionClosed:
            pass


if len(sys.argv) > 2:
    slow()
else:
    refused_origin()
    hostile()
    asyncio.run(crowd())
    asyncio.run(friend())
    asyncio.run(recording())
    asyncio.run(flood())
    asyncio.run(too_long())
    asyncio.run(friend())
    print("publish: the friend was served, strangers were refused")
