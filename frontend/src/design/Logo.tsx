/** The sign of VIPO; decoration, the word stands beside it. */
export function Logo({ size = 26 }: { size?: number }) {
  return (
    <svg width={size} height={size} viewBox="0 0 26 26" aria-hidden="true" style={{ flex: "none" }}>
      <defs>
        <linearGradient id="vipo-logo" x1="0" y1="0" x2="0" y2="1">
          <stop stopColor="#6D65F5" />
          <stop offset="1" stopColor="#4338CA" />
        </linearGradient>
      </defs>
      <rect width="26" height="26" rx="7" fill="url(#vipo-logo)" />
      <path d="M6.8 7.6 11 17.4 14.6 12.4H19" stroke="#fff" strokeWidth="2" strokeLinecap="round" fill="none" />
      <g fill="#fff">
        <circle cx="6.6" cy="7.4" r="2.1" />
        <circle cx="11" cy="17.6" r="2.1" />
        <circle cx="19.4" cy="12.4" r="2.5" />
      </g>
    </svg>
  );
}
