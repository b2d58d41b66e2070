// node-wot over MQTT: finds a Thing by HTTP and observes a property at the broker with the same token; then the library
// under it tries with that account what it may not do. Says each finding as a line of JSON, until it is ended. It knows
// nothing of VIPO but what the description says.
import { createRequire } from "node:module";
import process from "node:process";

const require = createRequire(import.meta.url);
const { address, token, username, title, property } = JSON.parse(process.argv[2]);
const { Servient } = require("@node-wot/core");
const { HttpClientFactory } = require("@node-wot/binding-http");
const { MqttClientFactory, MqttsClientFactory } = require("@node-wot/binding-mqtt");
const mqtt = createRequire(require.resolve("@node-wot/binding-mqtt"))("mqtt");
/** No device says this of itself: a share of work done is from 0 to 100. */
const FORGED = "-4711";
const say = (what) => process.stdout.write(JSON.stringify(what) + "\n");

const finder = new Servient();
finder.addClientFactory(new HttpClientFactory());
const search = await finder.start();
console.debug = console.warn = () => {};
const directory = await search.requestThingDescription(`${address}/.well-known/wot`);
finder.addCredentials({ [directory.id]: { token } });
let description;
const found = await search.exploreDirectory(`${address}/.well-known/wot`);
for await (const thing of found) {
  if (thing.title === title) description = thing;
}

if (found.error) throw found.error;

const looker = new Servient();
looker.addClientFactory(new MqttClientFactory());
looker.addClientFactory(new MqttsClientFactory({ rejectUnauthorized: true }));
const wot = await looker.start();
const account = { username, password: token };
looker.addCredentials({ [description.id]: account });
// node-wot 0.8.16 gives a form with a security of its own the list of credentials in place of the first of them.
Object.assign(looker.retrieveCredentials(description.id), account);
const thing = await wot.consume(description);
/** An empty message says that there is no value just now, which node-wot takes for one of the wrong kind. */
const hear = async (output) => {
  try {
    say({ observed: await output.value() });
  } catch (error) {
    say(error.value === undefined ? { nothing: true } : { error: String(error) });
  }
};
await thing.observeProperty(
  property,
  hear,
  (error) => say({ error: String(error) }),
);
say({ observing: true });

process.stdin.on("data", () => {
  const { href } = description.properties[property].forms.at(-1);
  const [broker, topic] = [href.slice(0, href.indexOf("/vipo/")), href.slice(href.indexOf("vipo/"))];
  const other = mqtt.connect(broker, { ...account, reconnectPeriod: 300 });
  other.on("close", () => say({ closed: Date.now() / 1000 }));
  other.on("error", (error) => say({ refused: error.message }));
  other.once("connect", async () => {
    for (const filter of ["#", "vipo/v1/dev/+/up/#", "vipo/v1/site/+/things/#", topic.replace(/things.*/, "things/#")]) {
      const granted = await other.subscribeAsync(filter).catch(() => [{ qos: 128 }]);
      say({ granted: [filter, granted[0].qos !== 128] });
    }
    other.on("message", (at, payload) => payload.toString() === FORGED && say({ echo: at }));
    other.publish(topic, FORGED, { retain: true });
    say({ tried: true });
  });
});
