/** Who is signed in, and the sites that there are. */

export type Role = "viewer" | "operator" | "author" | "admin";

export interface User {
  id: number;
  name: string;
  initials: string;
  email: string;
}

export interface DemoAccount {
  email: string;
  password: string;
  role: Role;
}

export interface Me {
  user: User | null;
  csrf: string;
  demo_accounts: DemoAccount[];
}

export interface SiteStop {
  active: boolean;
  by: string | null;
  /** ISO 8601. */
  at: string | null;
}

export interface Site {
  slug: string;
  name: string;
  role: Role;
  machines: number;
  robots: number;
  online: number;
  pending: number;
  has_map: boolean;
  stop: SiteStop;
  simulated: boolean;
}
