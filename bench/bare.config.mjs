/** Builds the page of the folder that the command names with the libraries of the frontend. */
import { fileURLToPath } from "node:url";

const frontend = fileURLToPath(new URL("../frontend/src/main.tsx", import.meta.url));

export default {
  base: "./",
  plugins: [
    {
      name: "libraries-of-the-frontend",
      enforce: "pre",
      resolveId(source) {
        return /^[@a-z]/i.test(source) ? this.resolve(source, frontend, { skipSelf: true }) : null;
      },
    },
  ],
};
