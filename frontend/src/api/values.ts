/** Values that many shapes have. */

export type Point = [number, number];

export type Scalar = string | number | boolean;

/** Why something waits; devices are named by their ids. */
export interface WaitReason {
  code: string;
  args: Record<string, Scalar>;
}

/** Why something ended or was not done; devices are named as people name them. */
export interface Cause {
  code: string;
  args: Record<string, string>;
}

/** A sentence in each language of the screens. */
export interface Words {
  en: string;
  de: string;
}
