/** How many pixels of the screen a drawing pixel is, for what is drawn on a map and keeps its size. */
import { createContext } from "react";

export const ZoomContext = createContext(1);
