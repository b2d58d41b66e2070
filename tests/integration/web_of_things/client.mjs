// A client that nobody of VIPO has written: node-wot, given an address, a token and what to do; says each finding as a
// line of JSON. It knows nothing of VIPO but what the Thing Descriptions say.
import { createRequire } from "node:module";
import process from "node:process";

const require = createRequire(import.meta.url);
const { address, token, title, action, input, property, sse } = JSON.parse(process.argv[2]);

if (sse) {
  // node-wot 0.8.16 opens streams without its credentials: whoever wants them adds the header, as here.
  const forHttp = createRequire(require.resolve("@node-wot/binding-http"));
  const name = forHttp.resolve("eventsource");
  const EventSource = forHttp("eventsource");
  require.cache[name].exports = class extends EventSource {
    constructor(url) {
      super(url, { headers: { Authorization: `Bearer ${token}` } });
    }
  };
}

const { Servient } = require("@node-wot/core");
const { HttpClientFactory } = require("@node-wot/binding-http");
const say = (what) => process.stdout.write(JSON.stringify(what) + "\n");

const servient = new Servient();
servient.addClientFactory(new HttpClientFactory());
const wot = await servient.start();

console.debug = console.warn = () => {};
const directory = await wot.requestThingDescription(`${address}/.well-known/wot`);
servient.addCredentials({ [directory.id]: { token } });
const found = [];
const search = await wot.exploreDirectory(`${address}/.well-known/wot`);
for await (const thing of search) found.push(thing);
if (search.error) throw search.error;
say({ found: found.map((thing) => thing.title) });

const description = found.find((thing) => thing.title === title);
servient.addCredentials({ [description.id]: { token } });
const thing = await wot.consume(description);
say({ read: await (await thing.readProperty(property)).value() });
const all = await thing.readAllProperties();
say({ all: Object.fromEntries(await Promise.all([...all].map(async ([name, out]) => [name, await out.value()]))) });

const forms = description.properties[property].forms;
const formIndex = sse ? forms.findIndex((form) => form.subprotocol === "sse") : undefined;
let stopping = false;
const subscription = await thing.observeProperty(
  property,
  async (output) => say({ observed: await output.value() }),
  (error) => stopping || say({ error: String(error) }), // a poll that is under way ends as an error
  { formIndex },
);
const answer = await thing.invokeAction(action, input);
say({ answer: await answer.value() });
try {
  await thing.invokeAction(action, { nonsense: true });
} catch (error) {
  say({ refused: error.message });
}
stopping = true;
await subscription.stop();
await servient.shutdown();
process.exit(0);
