"""Prints every touch, and throws in a ball: python3 listen.py [ws://127.0.0.1:9980]. Needs python3-websockets."""
import asyncio
import json
import sys

import websockets


async def main(place):
    async with websockets.connect(place, max_size=None) as relief:
        ball = {"type": "spawn", "shape": "sphere", "radius": 0.1, "position": [0, 0, 1.5], "name": "ball"}
        await relief.send(json.dumps(ball))
        async for text in relief:
            message = json.loads(text)
            for c in message.get("contacts", []):
                if c["state"] == "begin":
                    print(f"{c['body']} meets {c['with']} {c['other']} at {c['position']}: {c['impulse']} N s", flush=True)


try:
    asyncio.run(main(sys.argv[1] if len(sys.argv) > 1 else "ws://127.0.0.1:9980"))
except (websockets.ConnectionClosed, KeyboardInterrupt):
    pass
