// A provider of OpenID Connect for tests: oidc-provider with people of the test's, whose sign-in page asks for a name alone.
// Told by JSON as its argument: issuer, port, client, people (claims by name), keys (JWKs), offset_s (its clock is off).
import { createServer } from "node:http";
import { Provider } from "oidc-provider";

const told = JSON.parse(process.argv[2]);
const now = Date.now;
Date.now = () => now() + told.offset_s * 1000;

/** The library's own page fetches fonts from elsewhere. */
function askToSignOut(ctx, form) {
  ctx.body = `<!doctype html><html lang="en"><title>Sign out</title>${form}
    <button form="op.logoutForm" name="logout" value="yes">Yes, sign me out</button></html>`;
}

const provider = new Provider(told.issuer, {
  clients: [told.client],
  jwks: { keys: told.keys },
  cookies: { keys: ["of this test alone"] },
  claims: { openid: ["sub", "amr"], email: ["email", "email_verified"], profile: ["name"], acr: null },
  enabledJWA: { idTokenSigningAlgValues: ["RS256", "HS256"] },
  ttl: { IdToken: 300 },
  features: {
    devInteractions: { enabled: false },
    backchannelLogout: { enabled: true },
    rpInitiatedLogout: { enabled: true, logoutSource: askToSignOut },
  },
  acrValues: ["two"],
  fetch: (url, { dispatcher: _, ...options }) => fetch(url, options), // it refuses addresses of one's own machine, and VIPO is here
  pkce: { required: () => true },
  interactions: { url: (_, interaction) => `/interaction/${interaction.uid}` },
  findAccount: (_, id) => (told.people[id] ? { accountId: id, claims: () => ({ sub: id, ...told.people[id] }) } : undefined),
  loadExistingGrant: async (ctx) => {
    const grant = new ctx.oidc.provider.Grant({ clientId: ctx.oidc.client.clientId, accountId: ctx.oidc.session.accountId });
    grant.addOIDCScope("openid email profile");
    await grant.save();
    return grant;
  },
});

const FORM = `<!doctype html><html lang="en"><title>The test's provider</title><form method="post">
  <label>Name there <input name="name" autofocus></label> <input type="hidden" name="amr"><input type="hidden" name="acr">
  <button name="do" value="in">Continue</button> <button name="do" value="deny">Deny</button></form></html>`;

async function read(request) {
  let body = "";
  for await (const piece of request) body += piece;
  return new URLSearchParams(body);
}

async function interact(request, response) {
  if (request.method !== "POST") return response.setHeader("Content-Type", "text/html").end(FORM);
  const said = await read(request);
  const login = { accountId: said.get("name"), acr: said.get("acr") || undefined, amr: said.get("amr")?.split(" ").filter(Boolean) };
  const result = said.get("do") === "deny" ? { error: "access_denied", error_description: "Denied." } : { login };
  return provider.interactionFinished(request, response, result, { mergeWithLastSubmission: false });
}

const handle = provider.callback();
provider.on("server_error", (_, error) => console.error(error));
provider.on("backchannel.error", (_, error) => console.error(error));
createServer((request, response) => {
  if (request.url === "/favicon.ico") return response.writeHead(204).end();
  const done = request.url.startsWith("/interaction/") ? interact(request, response) : handle(request, response);
  Promise.resolve(done).catch((error) => response.writeHead(500).end(String(error)));
}).listen(told.port, "127.0.0.1", () => console.log("ready"));
