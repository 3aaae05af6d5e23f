"""The same screens in a browser: each visitor's program runs on a pseudo-terminal of its own behind
a websocket, so that everything but the line is as in a terminal. Needs the extra `web`."""
