/** Who is signed in, what they may do here, and how the screen looks to them. */
import { Menu } from "@mantine/core";
import {
  Archive,
  Check,
  KeyRound,
  Languages,
  LogOut,
  Monitor,
  Moon,
  Sun,
  UserRound,
  type LucideIcon,
} from "lucide-react";
import { useTranslation } from "react-i18next";
import { Link } from "react-router-dom";
import { useMe } from "@/api/queries";
import type { Role, User } from "@/api/types";
import { Avatar } from "@/design/Avatar";
import { IconButton } from "@/design/IconButton";
import { chooseLanguage, LANGUAGES } from "@/i18n";
import styles from "./sidebar.module.css";
import { SignOutQuestion, useSignOut } from "./SignOut";
import { chooseTheme, useTheme, useThemeChoice, type ThemeChoice } from "./theme";

const THEMES: readonly [ThemeChoice, LucideIcon][] = [
  ["light", Sun],
  ["dark", Moon],
  ["system", Monitor],
];

function ThemeMenu() {
  const { t } = useTranslation();
  const choice = useThemeChoice();
  const Shown = useTheme() === "dark" ? Moon : Sun;
  return (
    <Menu width={170} position="top-end">
      <Menu.Target>
        <IconButton label={t("shell.theme.choose")}>
          <Shown size={17} aria-hidden="true" />
        </IconButton>
      </Menu.Target>
      <Menu.Dropdown>
        {THEMES.map(([name, Icon]) => (
          <Menu.Item
            key={name}
            leftSection={<Icon size={15} />}
            rightSection={name === choice ? <Check size={15} /> : null}
            onClick={() => chooseTheme(name)}
          >
            {t(`shell.theme.${name}`)}
          </Menu.Item>
        ))}
      </Menu.Dropdown>
    </Menu>
  );
}

function AccountMenu({ user, role, slug }: { user: User; role: Role | undefined; slug: string | undefined }) {
  const { t, i18n } = useTranslation();
  const signOut = useSignOut("/sign-out");
  return (
    <>
      <SignOutQuestion signOut={signOut} />
      <Menu width={220} position="top-start">
        <Menu.Target>
          <button type="button" className={styles.account}>
            <Avatar name={user.name} initials={user.initials} size={26} />
            <span className={styles.switchText}>
              <strong>{user.name}</strong>
              <small>{role ? t(`shell.role.${role}`) : user.email}</small>
            </span>
            <span className="visually-hidden">{t("shell.account.menu")}</span>
          </button>
        </Menu.Target>
        <Menu.Dropdown>
          <Menu.Label>{user.email}</Menu.Label>
          {LANGUAGES.map((language) => (
            <Menu.Item
              key={language}
              leftSection={<Languages size={15} />}
              rightSection={i18n.language === language ? <Check size={15} /> : null}
              onClick={() => void chooseLanguage(language)}
            >
              {t(`shell.language.${language}`)}
            </Menu.Item>
          ))}
          <Menu.Divider />
          <Menu.Item component={Link} to="/account" leftSection={<UserRound size={15} />}>
            {t("shell.account.settings")}
          </Menu.Item>
          {slug ? (
            <Menu.Item component={Link} to={`/sites/${slug}/tokens`} leftSection={<KeyRound size={15} />}>
              {t("tokens.menu")}
            </Menu.Item>
          ) : null}
          {slug && role === "admin" ? (
            <Menu.Item component={Link} to={`/sites/${slug}/retention`} leftSection={<Archive size={15} />}>
              {t("retention.menu")}
            </Menu.Item>
          ) : null}
          <Menu.Item leftSection={<LogOut size={15} />} onClick={signOut.ask}>
            {t("shell.account.signOut")}
          </Menu.Item>
        </Menu.Dropdown>
      </Menu>
    </>
  );
}

export function AccountBar({ role, slug }: { role: Role | undefined; slug: string | undefined }) {
  const user = useMe().data?.user;
  return (
    <div className={styles.foot}>
      {user ? <AccountMenu user={user} role={role} slug={slug} /> : null}
      <ThemeMenu />
    </div>
  );
}
