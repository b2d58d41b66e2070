// Hocuspocus on a port of this machine, as its own documentation starts it; nothing is stored.
import { Server } from "@hocuspocus/server";

const { HOST: address, PORT } = process.env;
await new Server({ port: Number(PORT), address, quiet: true, websocketOptions: { perMessageDeflate: false } }).listen();
